#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "cli/render/background.hpp"
#include "cli/render/output/output_name.hpp"
#include "protocol/messages/render_messages.hpp"
#include "protocol/settings/settings.hpp"

namespace heliograph::cli {

/// One entry of a command or of a manifest, checked as far as that is possible without its scene.
struct RenderTask {
  std::size_t number;  // from 1 on, in the whole manifest
  protocol::RenderRequest request;
  OutputName output;
  protocol::FileFormat format;
  protocol::Settings settings;
  Background background;
};

/// Whether a file of this format holds all frames of a camera.
bool holds_frames(protocol::FileFormat format);

/// The entries that the options name, of their shard.
/// @throws std::invalid_argument, std::runtime_error naming the option, or the manifest's entry
std::vector<RenderTask> make_tasks(const RenderOptions& options);

}  // namespace heliograph::cli
