#pragma once

#include <string>

#include "render/api/renderer.hpp"

namespace heliograph::test {

/// Writes NAME.png into $HELIOGRAPH_TEST_OUTPUT for inspection; no-op where the variable is unset.
void save_image(const std::string& name, const render::Frame& frame);

/// Expects a mean absolute difference of at most `mean` code values of 255 and an SSIM of at least
/// `similarity`. On failure writes NAME_differs.png: expected, actual and 8 x difference.
void expect_similar(const std::string& name, const render::Frame& expected,
                    const render::Frame& actual, double mean, double similarity);

}  // namespace heliograph::test
