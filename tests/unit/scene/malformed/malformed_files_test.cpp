// Damage to the container, the JSON text, external references and images.
#include <gtest/gtest.h>

#include "tests/unit/scene/malformed/malformed.hpp"
#include "tests/unit/scene/malformed/rich_document.hpp"
#include "tests/unit/scene/support/encoders.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

void set_u32(Bytes& file, std::size_t offset, std::uint32_t value) {
  std::memcpy(file.data() + offset, &value, sizeof value);
}

std::uint32_t get_u32(const Bytes& file, std::size_t offset) {
  std::uint32_t value = 0;
  std::memcpy(&value, file.data() + offset, sizeof value);
  return value;
}

Bytes to_bytes(std::string_view text) {
  return Bytes(text.begin(), text.end());
}

class MalformedFiles : public Malformed {
 protected:
  void refuse_text(const std::string& what, std::string_view text, std::string_view place) {
    expect_refused(what, to_bytes(text), place, "scene.gltf");
  }
  void refuse_image(const std::string& what, const Bytes& image) {
    GltfBuilder damaged = good_;
    damaged.json["images"][0]["bufferView"] = damaged.add_view(image);
    expect_refused(what, damaged, "images[0]");
  }

  const GltfBuilder good_ = rich_document();
};

TEST_F(MalformedFiles, InvalidHeaders) {
  const Bytes good = good_.glb();
  const std::uint32_t json_size = get_u32(good, 12);
  const auto refuse_with = [&](std::size_t offset, std::uint32_t value) {
    Bytes file = good;
    set_u32(file, offset, value);
    expect_refused("word " + std::to_string(offset) + " = " + std::to_string(value), file, "");
  };
  const auto size = static_cast<std::uint32_t>(good.size());
  for (const std::uint32_t magic : {0u, 0x46546c68u, 0x666c7467u}) refuse_with(0, magic);
  for (const std::uint32_t version : {0u, 1u, 3u, 99u, 0xffffffffu}) refuse_with(4, version);
  for (const std::uint32_t length : {0u, 8u, 12u, 19u, size + 1, 2 * size, 0xffffffffu}) {
    refuse_with(8, length);
  }
  for (const std::uint32_t length : {0u, 1u, json_size - 8, size, 0x7fffffffu, 0xfffffffcu}) {
    refuse_with(12, length);
  }
  for (const std::uint32_t type : {0u, 0x004e4942u, 0x4e4f534bu}) refuse_with(16, type);
  refuse_with(20 + json_size, size);
  refuse_with(20 + json_size, 0xffffffffu);
  refuse_with(20 + json_size, 4);
  refuse_with(24 + json_size, 0x4e4f534a);
}

TEST_F(MalformedFiles, TruncatedFiles) {
  const Bytes good = good_.glb();
  for (std::size_t size = 1; size < good.size(); size += size < 24 ? 1 : 97) {
    expect_refused("cut to " + std::to_string(size), Bytes(good.begin(), good.begin() + size), "");
  }
}

TEST_F(MalformedFiles, InvalidJsonTexts) {
  const std::string good = "{\"asset\": {\"version\": \"2.0\"}}";
  refuse_text("nothing but space", " \n\t ", "not a glTF file");
  refuse_text("an array", "[" + good + "]", "not a glTF file");
  refuse_text("text behind", good + good, "JSON syntax error");
  refuse_text("a comment", "{/* */\"asset\": {\"version\": \"2.0\"}}", "JSON syntax error");
  refuse_text("a comma too many", "{\"asset\": {\"version\": \"2.0\"},}", "JSON syntax error");
  refuse_text("single quotes", "{'asset': {'version': '2.0'}}", "JSON syntax error");
  refuse_text("no number", "{\"asset\": {\"version\": \"2.0\"}, \"scene\": NaN}", "JSON syntax");
  refuse_text("an endless number", "{\"asset\": {\"version\": \"2.0\"}, \"scene\": 1e999}",
              "number");
  refuse_text("no UTF-8", "{\"asset\": {\"version\": \"2.0\"}, \"x\": \"\xc3\x28\"}",
              "JSON syntax");
  refuse_text("half a pair", "{\"asset\": {\"version\": \"2.0\"}, \"x\": \"\\ud800\"}", "JSON");
  refuse_text("a raw line end", "{\"asset\": {\"version\": \"2.0\"}, \"x\": \"\n\"}", "JSON");
  for (std::size_t size = 1; size < good.size(); ++size) {
    refuse_text("cut to " + std::to_string(size), good.substr(0, size), "");
  }
  for (const char* const open : {"[", "{\"a\":", "[{\"a\":"}) {
    std::string deep = "{\"asset\": {\"version\": \"2.0\"}, \"extras\": ";
    for (int i = 0; i < 200'000; ++i) deep += open;
    refuse_text("nested deeply", deep, "nests deeper than");
  }
}

TEST_F(MalformedFiles, TooManyJsonValues) {
  std::string text = "{\"asset\": {\"version\": \"2.0\"}, \"extras\": [";
  for (int i = 0; i < 17'000'000; ++i) text += "0,";
  text += "0]}";
  refuse_text("more values than the limit", text, "values");
}

TEST_F(MalformedFiles, UnsupportedVersions) {
  for (const json& version : {json("1.0"), json("3.0"), json("2"), json(""), json("x"), json(2.0),
                              json("20.0"), json(nullptr)}) {
    GltfBuilder damaged = good_;
    damaged.json["asset"]["version"] = version;
    expect_refused(version.dump(), damaged, "asset.version");
  }
  for (const json& version : {json("1.0"), json("3.0"), json("x"), json(2.0)}) {
    GltfBuilder damaged = good_;
    damaged.json["asset"]["minVersion"] = version;
    expect_refused(version.dump(), damaged, "asset.minVersion");
  }
}

TEST_F(MalformedFiles, UnsupportedRequiredExtensions) {
  for (const char* const name : {"MSFT_texture_dds", "EXT_unknown", "khr_lights_punctual", ""}) {
    GltfBuilder damaged = good_;
    damaged.json["extensionsRequired"].push_back(name);
    expect_refused(name, damaged,
                   "requires extensions that are not supported: \"" + std::string(name) + "\"");
  }
  GltfBuilder damaged = good_;
  damaged.json["extensionsRequired"] = {"EXT_one", "KHR_lights_punctual", "EXT_two"};
  expect_refused("two of three", damaged, "\"EXT_one\", \"EXT_two\"");
}

TEST_F(MalformedFiles, RejectedUris) {
  files().write("beside.bin", Bytes(64, 'b'));
  const std::string_view cases[] = {"../beside.bin",
                                    "..%2Fbeside.bin",
                                    "%2e%2e/beside.bin",
                                    "x/../../beside.bin",
                                    "/etc/passwd",
                                    "%2Fetc%2Fpasswd",
                                    "//etc/passwd",
                                    "/dev/zero",
                                    "/dev/stdin",
                                    "/proc/self/mem",
                                    "/proc/self/environ",
                                    "file:///etc/passwd",
                                    "file:beside.bin",
                                    "http://127.0.0.1/beside.bin",
                                    "https://example.org/x.bin",
                                    "ftp://x",
                                    "missing.bin",
                                    ".",
                                    "",
                                    "beside.bin/",
                                    "beside.bin/x",
                                    "beside.bin%00",
                                    "beside.bin%",
                                    "beside.bin%4",
                                    "beside.bin%zz",
                                    "data:,hello",
                                    "data:application/octet-stream,hello",
                                    "data:application/octet-stream;base64,",
                                    "data:application/octet-stream;base64,!!!!",
                                    "data:application/octet-stream;base64,A",
                                    "data:application/octet-stream;base64,AAAA",
                                    "data:;base64",
                                    "data:",
                                    "\\\\host\\share"};
  for (const std::string_view uri : cases) {
    const json document = {{"asset", {{"version", "2.0"}}},
                           {"buffers", {{{"byteLength", 36}, {"uri", uri}}}},
                           {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}}};
    refuse_text(std::string(uri), document.dump(), "buffers[0]");
    const json image = {{"asset", {{"version", "2.0"}}},
                        {"images", {{{"uri", uri}}}},
                        {"textures", {{{"source", 0}}}},
                        {"materials", {{{"normalTexture", {{"index", 0}}}}}}};
    refuse_text(std::string(uri) + " (image)", image.dump(), "images[0]");
  }
}

TEST_F(MalformedFiles, DamagedPngImages) {
  const Bytes good = png(16, 16, 4, Bytes(1024, 9));
  for (std::size_t size = 0; size < good.size(); size += size < 40 ? 3 : 41) {
    if (size != 0)
      refuse_image("cut to " + std::to_string(size), Bytes(good.begin(), good.begin() + size));
  }
  // Width, height, depth, color type, compression, filter, interlace: with the old checksum.
  for (std::size_t offset = 16; offset < 29; ++offset) {
    Bytes file = good;
    file[offset] ^= 0x41;
    refuse_image("header byte " + std::to_string(offset), file);
  }
  for (std::size_t offset = 37; offset < good.size() - 12; offset += 101) {
    Bytes file = good;
    file[offset] ^= 0x55;
    refuse_image("byte " + std::to_string(offset), file);
  }
  refuse_image("no pixels", png(0, 0, 4, {}));
  refuse_image("no rows", png(16, 0, 4, {}));
  refuse_image("60000 x 60000 of nothing", png(60000, 60000, 4, {}));
  refuse_image("8193 wide", png(8193, 1, 4, Bytes(8193 * 4, 0)));
  refuse_image("fewer rows than said", png(16, 64, 4, Bytes(1024, 9)));
  refuse_image("far more rows than said", png(2, 2, 4, Bytes(1 << 20, 9)));
}

TEST_F(MalformedFiles, DamagedJpegImages) {
  for (const bool progressive : {false, true}) {
    const Bytes good = jpeg(32, 32, Bytes(32 * 32 * 3, 77), progressive);
    for (std::size_t size = 1; size + 2 < good.size(); size += 29) {
      refuse_image("cut to " + std::to_string(size), Bytes(good.begin(), good.begin() + size));
    }
  }
}

TEST_F(MalformedFiles, DamagedWebPImages) {
  Bytes pixels;
  for (int i = 0; i < 32 * 32 * 4; ++i) pixels.push_back(static_cast<std::uint8_t>(i * i >> 4));
  for (const bool lossless : {false, true}) {
    const Bytes good = webp(32, 32, pixels, lossless);
    for (std::size_t size = 1; size + 64 < good.size(); size += 61) {
      refuse_image("cut to " + std::to_string(size), Bytes(good.begin(), good.begin() + size));
    }
  }
}

TEST_F(MalformedFiles, UnsupportedImageFormats) {
  refuse_image("text", to_bytes("<svg xmlns='http://www.w3.org/2000/svg'/>"));
  refuse_image("GIF", to_bytes("GIF89a\x01\x01"));
  refuse_image("BMP", to_bytes("BM0000000000"));
  refuse_image("KTX2", to_bytes("\xabKTX 20\xbb\r\n\x1a\n"));
  refuse_image("DDS", to_bytes("DDS |"));
  refuse_image("half a RIFF", to_bytes("RIFF\x10\x10\x10\x10WEBP"));
}

// Images of maximum size with tiny files must not exceed the budget.
TEST_F(MalformedFiles, ImagesBeyondBudget) {
  GltfBuilder damaged = good_;
  for (int i = 0; i < 8; ++i) {
    const auto image = damaged.add_image(png(8192, 8192, 4, {}));
    const auto texture = damaged.add("textures", {{"source", image}});
    damaged.add("materials", {{"normalTexture", {{"index", texture}}}});
  }
  expect_refused("eight of 64 million texels", damaged, "texels");
}

}  // namespace
}  // namespace heliograph::scene::test
