#include "cli/compare/image_source.hpp"

#include <stdlib.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/commands.hpp"
#include "cli/render/render_plan.hpp"
#include "net/http/http_client.hpp"
#include "scene/image/image_decoder.hpp"

namespace heliograph::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::minutes longest_answer{5};

/// A folder of its own, gone afterwards.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = (fs::temp_directory_path() / "heliograph-compare-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder can be made");
    path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

ComparedImage decoded(std::span<const std::uint8_t> file) {
  const scene::ImageSize size = scene::probe_image(file);
  ComparedImage image{size.width, size.height, {}};
  image.rgba.resize(std::size_t{4} * size.width * size.height);
  scene::decode_image(file, size, image.rgba);
  return image;
}

ComparedImage read_image(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  if (bytes.empty()) throw std::runtime_error("the file does not exist, or is empty");
  return decoded({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

NamedImages rendered(const std::string& scene, RenderOptions options) {
  const ScratchFolder folder;
  options.scenes = {scene};
  options.request.output = (folder.path() / "{camera}.png").string();
  options.progress = "none";
  if (run(options) != 0) throw std::runtime_error("was not rendered");
  NamedImages images;
  for (const fs::directory_entry& file : fs::directory_iterator(folder.path())) {
    images.emplace(file.path().stem().string(), read_image(file.path()));
  }
  return images;
}

/// The address of a session's image; that of a server stands for its main session.
std::string image_address(std::string url, const protocol::RenderRequest& request) {
  if (url.find("/frame.") != std::string::npos) return url;
  while (url.ends_with('/')) url.pop_back();
  const FrameSize size = frame_size(request);
  url += "/api/v1/sessions/main/frame.png?width=" + std::to_string(size.width) +
         "&height=" + std::to_string(size.height);
  if (!request.camera.empty()) url += "&camera=" + net::encode_query(request.camera);
  if (request.samples) url += "&samples=" + std::to_string(*request.samples);
  return url;
}

ComparedImage image_of_server(const std::string& url, const RenderOptions& options,
                              const CompareOptions& compared) {
  net::ClientRequest request{.url = image_address(url, options.request),
                             .authorities = compared.authorities,
                             .timeout = longest_answer};
  if (!compared.token.empty()) {
    request.headers.emplace_back("Authorization", "Bearer " + compared.token);
  }
  const net::ClientAnswer answer = net::ask_server(request);
  if (answer.status == 0) throw std::runtime_error(answer.error);
  if (answer.status != 200) throw std::runtime_error(answer.body.substr(0, answer.body.find('\n')));
  return decoded({reinterpret_cast<const std::uint8_t*>(answer.body.data()), answer.body.size()});
}

}  // namespace

NamedImages images_of(const std::string& source, const RenderOptions& options,
                      const CompareOptions& compared) {
  try {
    const std::string_view text = source;
    if (text.ends_with(".glb") || text.ends_with(".gltf")) return rendered(source, options);
    const bool server = text.starts_with("http://") || text.starts_with("https://");
    return {{"image", server ? image_of_server(source, options, compared) : read_image(source)}};
  } catch (const std::exception& failure) {
    throw std::runtime_error(source + ": " + failure.what());
  }
}

}  // namespace heliograph::cli
