#pragma once

#include <string>

#include "render/api/renderer.hpp"

namespace heliograph::test {

/// Writes NAME.png into $HELIOGRAPH_TEST_OUTPUT for a person to look at; without it, nothing.
void save_picture(const std::string& name, const render::Frame& frame);

/// Expects the mean absolute difference of two pictures, in code values of 255, to be at most
/// `mean` and the structural similarity at least `similarity`. A failure leaves NAME_differs.png:
/// expected, actual and eight times the difference side by side.
void expect_similar(const std::string& name, const render::Frame& expected,
                    const render::Frame& actual, double mean, double similarity);

}  // namespace heliograph::test
