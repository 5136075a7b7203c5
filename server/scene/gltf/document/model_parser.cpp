#include "scene/gltf/document/model_parser.hpp"

#include <charconv>
#include <string_view>

#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

constexpr std::string_view buffer_prefix = "buffers[";

struct Source {
  const CheckedDocument& document;
  const BufferReader& read;
};

bool exists(const std::string&, void*) {
  return true;
}

std::string unchanged(const std::string& name, void*) {
  return name;
}

/// `name` is the place of the buffer, as the checked document has it, or a stand-in's name.
bool read_buffer(std::vector<unsigned char>* bytes, std::string*, const std::string& name,
                 void* user) {
  const Source& source = *static_cast<const Source*>(user);
  if (!std::string_view(name).starts_with(buffer_prefix)) {
    bytes->assign(1, 0);
    return true;
  }
  std::size_t index = 0;
  std::from_chars(name.data() + buffer_prefix.size(), name.data() + name.size(), index);
  *bytes = source.read(index);
  return true;
}

bool write_nothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
  return false;
}

/// Images stay encoded: they are probed, budgeted and decoded by this project's decoders.
bool keep_encoded(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*,
                  int, void*) {
  return true;
}

}  // namespace

tinygltf::Model parse_model(const CheckedDocument& document, const BufferReader& read) {
  Source source{document, read};
  tinygltf::TinyGLTF parser;
  tinygltf::FsCallbacks files{};
  files.FileExists = exists;
  files.ExpandFilePath = unchanged;
  files.ReadWholeFile = read_buffer;
  files.WriteWholeFile = write_nothing;
  files.user_data = &source;
  parser.SetFsCallbacks(files);
  parser.SetImageLoader(keep_encoded, nullptr);
  tinygltf::Model model;
  std::string error;
  std::string warning;
  const bool parsed =
      parser.LoadASCIIFromString(&model, &error, &warning, document.text.data(),
                                 static_cast<unsigned int>(document.text.size()), "");
  if (!parsed)
    throw ImportError("the document cannot be parsed: " + error.substr(0, error.find('\n')));
  return model;
}

}  // namespace heliograph::scene
