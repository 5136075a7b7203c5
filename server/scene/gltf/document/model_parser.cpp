#include "scene/gltf/document/model_parser.hpp"

#include <string>
#include <vector>

#include "scene/import_error.hpp"

namespace heliograph::scene {
namespace {

bool exists(const std::string&, void*) {
  return true;
}

std::string unchanged(const std::string& name, void*) {
  return name;
}

bool read_stand_in(std::vector<unsigned char>* bytes, std::string*, const std::string&, void*) {
  bytes->assign(1, 0);
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

tinygltf::Model parse_model(const CheckedDocument& document) {
  tinygltf::TinyGLTF parser;
  tinygltf::FsCallbacks files{};
  files.FileExists = exists;
  files.ExpandFilePath = unchanged;
  files.ReadWholeFile = read_stand_in;
  files.WriteWholeFile = write_nothing;
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
