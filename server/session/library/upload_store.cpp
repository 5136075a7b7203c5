#include "session/library/upload_store.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "scene/import_error.hpp"
#include "session/event_log.hpp"

namespace heliograph::session {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_name_length = 64;
constexpr std::size_t max_queued_checks = 4;
constexpr std::size_t glb_header_bytes = 12;
constexpr std::string_view exr_magic = "\x76\x2f\x31\x01";

bool is_valid_name(const std::string& name) {
  const bool characters = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
  return characters && !name.empty() && name.size() <= max_name_length && name.front() != '-';
}

std::uint32_t little_endian(const unsigned char* bytes) {
  return bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
}

bool starts_with(const fs::path& file, std::string_view magic) {
  std::string start(magic.size(), '\0');
  std::ifstream stream(file, std::ios::binary);
  return stream.read(start.data(), std::ssize(start)) && start == magic;
}

/// The extension of an image's file by its first bytes; PNG where it is none of the others.
std::string_view image_extension(const fs::path& file) {
  using namespace std::string_view_literals;
  if (starts_with(file, "\xff\xd8"sv)) return ".jpg";
  if (starts_with(file, "RIFF"sv)) return ".webp";
  return starts_with(file, "\xabKTX 20"sv) ? ".ktx2" : ".png";
}

std::string_view described(UploadKind kind) {
  switch (kind) {
    case UploadKind::scene:
      return "a scene";
    case UploadKind::environment:
      return "an environment";
    case UploadKind::image:
      break;
  }
  return "an image";
}

/// Those that files of a kind have, in the order of their precedence.
std::span<const std::string_view> extensions_of(UploadKind kind) {
  static constexpr std::array<std::string_view, 1> scenes{".glb"};
  static constexpr std::array<std::string_view, 2> environments{".hdr", ".exr"};
  static constexpr std::array<std::string_view, 5> images{".png", ".jpg", ".jpeg", ".webp",
                                                          ".ktx2"};
  switch (kind) {
    case UploadKind::scene:
      return scenes;
    case UploadKind::environment:
      return environments;
    case UploadKind::image:
      break;
  }
  return images;
}

protocol::Error invalid_name(UploadKind kind) {
  return protocol::error::invalid("name", "is not a valid name of " + std::string(described(kind)),
                                  "1 to 64 letters, digits, _ and -");
}

/// The fault in the header of a binary glTF file (specification section 4.4.2), or nothing.
std::string_view header_fault(const fs::path& file) {
  std::array<unsigned char, glb_header_bytes> header{};
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(reinterpret_cast<char*>(header.data()), header.size()))
    return "is too short for a .glb file";
  if (std::memcmp(header.data(), "glTF", 4) != 0) return "is not a binary glTF file (.glb)";
  if (little_endian(&header[4]) != 2) return "is not glTF 2";
  if (little_endian(&header[8]) != fs::file_size(file))
    return "does not have the length that its header states";
  return {};
}

}  // namespace

UploadStore::UploadStore(UploadOptions options)
    : options_(std::move(options)),
      importer_(options_.import_arguments),
      checker_("upload checker", max_queued_checks) {
  try {
    fs::create_directories(options_.folder / "scenes");
    fs::create_directories(options_.folder / "environments");
    fs::create_directories(options_.folder / "images");
    scenes_ = fs::canonical(options_.folder / "scenes");
    environments_ = fs::canonical(options_.folder / "environments");
    images_ = fs::canonical(options_.folder / "images");
    incoming_ = scenes_.parent_path() / "incoming";
    fs::remove_all(incoming_);
    fs::create_directories(incoming_);
  } catch (const fs::filesystem_error& failure) {
    throw std::runtime_error("the folder for uploads, " + options_.folder.string() +
                             ", cannot be used: " + failure.code().message());
  }
}

protocol::Result<std::shared_ptr<UploadStore::Incoming>> UploadStore::begin(UploadKind kind,
                                                                            const std::string& name,
                                                                            std::uint64_t bytes) {
  if (!is_valid_name(name)) return invalid_name(kind);
  if (bytes > options_.max_bytes) {
    return protocol::error::too_large("body", "is too large",
                                      std::to_string(options_.max_bytes) + " bytes");
  }
  const std::lock_guard lock(mutex_);
  if (bytes_kept() + reserved_bytes_ + bytes > options_.quota) {
    return protocol::error::full("the quota of uploaded files is used up",
                                 std::to_string(options_.quota) + " bytes");
  }
  const fs::path folder = incoming_ / std::to_string(++upload_count_);
  std::error_code error;
  fs::create_directory(folder, error);
  if (error) return protocol::error::internal();
  reserved_bytes_ += bytes;
  return std::make_shared<Incoming>(*this, kind, name, bytes, folder);
}

void UploadStore::finish(std::shared_ptr<Incoming> incoming,
                         std::function<void(protocol::Result<UploadedFile>)> done) {
  // The task is its only owner, so that its reserved bytes are released before `done`.
  const bool taken = checker_.post([this, incoming = std::move(incoming), done]() mutable {
    protocol::Result<UploadedFile> result = accept(*incoming);
    incoming.reset();
    done(std::move(result));
  });
  if (!taken) done(protocol::error::full("too many uploads are being checked"));
}

protocol::Result<UploadedFile> UploadStore::accept(Incoming& incoming) {
  const auto refused = [&](const std::string& why) {
    log_warning({}, "the upload " + incoming.name() + " was refused: " + why);
    return protocol::error::invalid("body", why);
  };
  try {
    const fs::path file = incoming.path();
    const bool is_scene = incoming.kind() == UploadKind::scene;
    const std::string_view fault = is_scene ? header_fault(file) : std::string_view();
    if (!fault.empty()) return refused(std::string(fault));
    UploadedFile uploaded{
        .kind = incoming.kind(), .name = incoming.name(), .bytes = fs::file_size(file)};
    if (is_scene) accept_scene(incoming, uploaded);
    if (incoming.kind() == UploadKind::environment) accept_environment(incoming, uploaded);
    if (incoming.kind() == UploadKind::image) accept_image(incoming, uploaded);
    log_info({}, "the upload " + incoming.name() +
                     " was accepted: " + std::to_string(uploaded.bytes) + " bytes");
    return uploaded;
  } catch (const scene::ImportError& failure) {
    return refused("cannot be loaded: " + std::string(failure.what()));
  } catch (const std::exception& failure) {
    log_error({}, "the upload " + incoming.name() + " failed: " + failure.what());
    return protocol::error::internal();
  }
}

/// Alone: a file that needs others fails here and not in the catalogue.
void UploadStore::accept_scene(Incoming& incoming, UploadedFile& accepted) {
  accepted.triangles =
      importer_.import(ImportKind::scene, incoming.name(), incoming.path()).triangles;
  incoming.keep_as(scenes_ / (incoming.name() + ".glb"));
}

/// Its content tells its format; one of the same name is replaced, in whichever format it is.
void UploadStore::accept_environment(Incoming& incoming, UploadedFile& accepted) {
  const ImportedFile imported =
      importer_.import(ImportKind::environment, incoming.name(), incoming.path());
  accepted.width = imported.width;
  accepted.height = imported.height;
  const bool exr = starts_with(incoming.path(), exr_magic);
  incoming.keep_as(environments_ / (incoming.name() + (exr ? ".exr" : ".hdr")));
  std::error_code ignored;
  fs::remove(environments_ / (incoming.name() + (exr ? ".hdr" : ".exr")), ignored);
}

/// The same of an image of textures.
void UploadStore::accept_image(Incoming& incoming, UploadedFile& accepted) {
  const ImportedFile imported =
      importer_.import(ImportKind::image, incoming.name(), incoming.path());
  accepted.width = imported.width;
  accepted.height = imported.height;
  const std::string_view own = image_extension(incoming.path());
  incoming.keep_as(images_ / (incoming.name() + std::string(own)));
  std::error_code ignored;
  for (const std::string_view other : extensions_of(incoming.kind())) {
    if (other != own) fs::remove(images_ / (incoming.name() + std::string(other)), ignored);
  }
}

protocol::Result<void> UploadStore::remove(UploadKind kind, const std::string& name) {
  if (!is_valid_name(name)) return invalid_name(kind);
  const std::lock_guard lock(mutex_);
  bool removed = false;
  // All of them: none appears in the place of another.
  for (const std::string_view extension : extensions_of(kind)) {
    std::error_code error;
    removed |= fs::remove(folder_of(kind) / (name + std::string(extension)), error);
    if (!error) continue;
    log_error({}, "the upload " + name + " could not be deleted: " + error.message());
    return protocol::error::internal();
  }
  if (!removed) return protocol::error::not_found("name", "is not the name of an upload");
  log_info({}, "the upload " + name + " was deleted");
  return {};
}

const fs::path& UploadStore::folder_of(UploadKind kind) const {
  if (kind == UploadKind::scene) return scenes_;
  return kind == UploadKind::environment ? environments_ : images_;
}

bool is_upload(const CatalogueEntry& entry) {
  return is_valid_name(entry.name) && entry.path.extension() != ".gltf";
}

void UploadStore::stop() {
  importer_.stop();
  checker_.stop();
}

std::uint64_t UploadStore::bytes_kept() const {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (const fs::path& folder : {scenes_, environments_, images_}) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
      const std::uintmax_t size = entry.file_size(error);
      if (!error) bytes += size;
    }
  }
  return bytes;
}

UploadStore::Incoming::Incoming(UploadStore& store, UploadKind kind, std::string name,
                                std::uint64_t bytes, fs::path folder)
    : store_(store),
      kind_(kind),
      name_(std::move(name)),
      bytes_(bytes),
      folder_(std::move(folder)) {}

UploadStore::Incoming::~Incoming() {
  const std::lock_guard lock(store_.mutex_);
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
  store_.reserved_bytes_ -= bytes_;
}

void UploadStore::Incoming::keep_as(const fs::path& file) {
  const std::lock_guard lock(store_.mutex_);
  fs::rename(path(), file);
  store_.reserved_bytes_ -= std::exchange(bytes_, 0);
}

}  // namespace heliograph::session
