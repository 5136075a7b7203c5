#include "cli/render/render_edits.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "protocol/json/codec.hpp"
#include "scene/animation/pose.hpp"
#include "session/edits/texture_edits.hpp"
#include "session/library/scene_catalogue.hpp"
#include "session/nodes/node_state.hpp"

namespace heliograph::cli {
namespace {

constexpr std::uintmax_t most_bytes = 64u << 20;

template <class Document>
Document read_document(const std::string& option, const std::string& file) {
  const std::string what = option + " " + file + ": ";
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(what + std::strerror(errno));
  std::error_code unknown;
  if (std::filesystem::file_size(file, unknown) > most_bytes && !unknown) {
    throw std::invalid_argument(what + "must be at most 64 MiB");
  }
  const std::string text(std::istreambuf_iterator<char>(in), {});
  const auto json = protocol::RawJson::parse(text);
  if (!json) throw std::invalid_argument(what + "is no JSON: " + json.error().message);
  auto document = protocol::decode<Document>(*json);
  if (!document) throw std::invalid_argument(what + document.error().message);
  return *std::move(document);
}

}  // namespace

protocol::EditDocument read_edits(const std::string& file) {
  return read_document<protocol::EditDocument>("--edits", file);
}

protocol::CameraPath read_path(const std::string& file) {
  return read_document<protocol::CameraPath>("--path", file);
}

std::filesystem::path edited_environment(const std::string& name,
                                         const std::filesystem::path& scene) {
  const std::filesystem::path folder = std::filesystem::absolute(scene).parent_path();
  const auto files = session::SceneCatalogue({folder}).list_files({".hdr", ".exr"});
  const auto found = std::ranges::find(files, name, &session::CatalogueEntry::name);
  if (found != files.end()) return found->path;
  if (name == "studio") return {};
  throw std::runtime_error("edits.environment.name: there is no " + name +
                           ".hdr or .exr beside the scene; --environment names a file");
}

std::vector<std::filesystem::path> image_folders(const std::string& images,
                                                 const std::string& edits,
                                                 const std::filesystem::path& scene) {
  if (!images.empty()) return {images};
  std::vector<std::filesystem::path> folders;
  for (const std::filesystem::path& file : {std::filesystem::path(edits), scene}) {
    if (!file.empty()) folders.push_back(std::filesystem::absolute(file).parent_path());
  }
  return folders;
}

std::vector<scene::TextureOverride> edited_textures(
    const protocol::EditDocument& document, const std::vector<std::filesystem::path>& folders) {
  if (document.textures.empty()) return {};
  auto textures = session::overrides_of(document, session::SceneCatalogue(folders));
  if (!textures) {
    throw std::runtime_error(textures.error().message + "; --images names the folder of images");
  }
  return *std::move(textures);
}

RenderEdits::RenderEdits(std::shared_ptr<const scene::Scene> scene,
                         const protocol::EditDocument& document)
    : scene_(std::move(scene)) {
  session::SceneEdits edits(scene_);
  session::NodeState nodes(scene_);
  const auto cut = section_.set(document.section.value_or(protocol::Section()), "edits.section.");
  for (const auto& fits :
       {edits.apply(document), session::apply_visibility(document, nodes), cut}) {
    if (!fits) throw std::runtime_error(fits.error().message);
  }
  parts_ = {.lights = edits.device_lights(),
            .materials = edits.device_materials(),
            .layers = edits.device_layers(),
            .hidden = nodes.hidden_instances()};
  members_ = edits.edited_members();
}

void RenderEdits::apply(render::Renderer& renderer) const {
  if (section_.enabled()) renderer.set_section(*section_.enabled());
}

void RenderEdits::show(render::Renderer& renderer, session::ShownParts& shown,
                       const std::string& clip, double seconds) const {
  shown.show(renderer, {.scene = scene_,
                        .edited = parts_,
                        .members = members_,
                        .clip = scene_ ? scene::find_clip(*scene_, clip) : nullptr,
                        .seconds = seconds});
}

}  // namespace heliograph::cli
