// Writes the seed files of fuzzers: heliograph-fuzz-seeds gltf|images|environments|textures FOLDER
#include <ImfRgbaFile.h>
#include <ImfTiledRgbaFile.h>
#include <png.h>
#include <turbojpeg.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/unit/scene/malformed/rich_document.hpp"
#include "tests/unit/scene/support/encoders.hpp"
#include "tests/unit/scene/support/ktx2_files.hpp"

namespace heliograph::scene::test {
namespace {

void write(const std::filesystem::path& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

void write_documents(const std::filesystem::path& folder) {
  write(folder / "triangle.glb", triangle().glb());
  write(folder / "everything.glb", everything().glb());
  const GltfBuilder rich = rich_document();
  write(folder / "rich.glb", rich.glb());
  // One mesh each, so that damage to one mesh does not prevent the import of the others.
  for (int mesh = 0; mesh < 4; ++mesh) {
    GltfBuilder single = rich;
    single.json["nodes"] = {{{"mesh", mesh}}};
    single.json["scenes"] = {{{"nodes", {0}}}};
    single.json.erase("animations");
    single.json.erase("skins");
    write(folder / ("mesh" + std::to_string(mesh) + ".glb"), single.glb());
  }
  DracoInput input;
  for (int i = 0; i < 16; ++i) input.positions.push_back({i % 4, i / 4, i % 3});
  for (std::uint32_t i = 0; i < 12; ++i) {
    if (i % 4 == 3) continue;
    for (const std::uint32_t corner : {0u, 1u, 4u, 4u, 1u, 5u}) input.indices.push_back(i + corner);
  }
  for (const bool sequential : {false, true}) {
    input.sequential = sequential;
    input.metadata = sequential;
    const DracoOutput packed = draco(input);
    GltfBuilder builder;
    const auto view = builder.add_view(packed.bytes);
    builder.json["accessors"] = {
        {{"componentType", 5126}, {"type", "VEC3"}, {"count", packed.vertices}}};
    builder.show(
        {{"attributes", {{"POSITION", 0}}},
         {"extensions",
          {{"KHR_draco_mesh_compression", {{"bufferView", view}, {"attributes", packed.ids}}}}}});
    write(folder / (sequential ? "sequential.glb" : "edgebreaker.glb"), builder.glb());
  }
}

Bytes radiance(bool encoded) {
  constexpr int width = 16, height = 8;
  Bytes file;
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n";
  file.assign(header.begin(), header.end());
  for (int y = 0; y < height; ++y) {
    if (!encoded) {
      for (int x = 0; x < width; ++x) {
        for (const int value : {16 * x, 32 * y, 99, 128}) file.push_back(std::uint8_t(value));
      }
      continue;
    }
    file.insert(file.end(), {2, 2, 0, width});
    for (int channel = 0; channel < 4; ++channel) {
      file.insert(file.end(), {128 + 12, std::uint8_t(40 * channel + y), 4, 1, 2, 3, 4});
    }
  }
  return file;
}

/// The old run-length encoding of Radiance: a pixel of ones repeats the previous one.
Bytes old_radiance() {
  Bytes file;
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 16\n";
  file.assign(header.begin(), header.end());
  for (std::uint8_t y = 0; y < 4; ++y) {
    file.insert(file.end(), {9, y, 200, 129, 1, 1, 1, 14, 7, 7, 7, 128});
  }
  return file;
}

/// An interlaced palette image with transparency and a gAMA chunk.
Bytes palette_png() {
  Bytes file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  const auto append = [](png_structp writer, png_bytep bytes, png_size_t size) {
    auto& to = *static_cast<Bytes*>(png_get_io_ptr(writer));
    to.insert(to.end(), bytes, bytes + size);
  };
  png_set_write_fn(png, &file, append, nullptr);
  png_set_IHDR(png, info, 16, 16, 4, PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_ADAM7,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  const png_color colors[] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {9, 9, 9}};
  png_set_PLTE(png, info, colors, 4);
  const png_byte alphas[] = {255, 128, 0};
  png_set_tRNS(png, info, alphas, 3, nullptr);
  png_set_gAMA(png, info, 0.45455);
  Bytes row(8, 0x12);
  std::vector<png_bytep> rows(16, row.data());
  png_set_rows(png, info, rows.data());
  png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_destroy_write_struct(&png, &info);
  return file;
}

/// `format`: TJPF_GRAY or TJPF_CMYK.
Bytes other_jpeg(int format, int sampling, const Bytes& pixels) {
  const tjhandle handle = tjInitCompress();
  unsigned char* data = nullptr;
  unsigned long size = 0;
  tjCompress2(handle, pixels.data(), 16, 0, 16, format, &data, &size, sampling, 80, 0);
  const Bytes file(data, data + size);
  tjFree(data);
  tjDestroy(handle);
  return file;
}

/// KTX2 of every kind that is decoded.
void write_textures(const std::filesystem::path& folder) {
  write(folder / "etc1s.ktx2", ktx2_of_etc1s());
  write(folder / "uastc.ktx2", ktx2_of_blocks(16, 16, Bytes(256, 0x1b)));
  write(folder / "zstandard.ktx2", ktx2_of_blocks(16, 16, Bytes(256, 0x1b), true));
}

/// Radiance and OpenEXR.
void write_environments(const std::filesystem::path& folder) {
  write(folder / "plain.hdr", radiance(false));
  write(folder / "encoded.hdr", radiance(true));
  write(folder / "old.hdr", old_radiance());
  std::vector<Imf::Rgba> pixels;
  for (int i = 0; i < 32 * 16; ++i) pixels.emplace_back(0.1f * float(i % 32), 0.2f, 3.0f, 1.0f);
  Imf::TiledRgbaOutputFile tiled((folder / "tiled.exr").c_str(), 32, 16, 8, 8, Imf::MIPMAP_LEVELS,
                                 Imf::ROUND_DOWN);
  tiled.setFrameBuffer(pixels.data(), 1, 32);
  for (int level = 0; level < tiled.numLevels(); ++level) {
    tiled.writeTiles(0, tiled.numXTiles(level) - 1, 0, tiled.numYTiles(level) - 1, level);
  }
  for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression) {
    for (const auto channels : {Imf::WRITE_RGB, Imf::WRITE_YC}) {
      const std::string name =
          "c" + std::to_string(compression) + (channels == Imf::WRITE_YC ? "_chroma" : "") + ".exr";
      const Imf::Header header(32, 16, 1.0f, {0.0f, 0.0f}, 1.0f, Imf::INCREASING_Y,
                               static_cast<Imf::Compression>(compression));
      Imf::RgbaOutputFile file((folder / name).c_str(), header, channels);
      file.setFrameBuffer(pixels.data(), 1, 32);
      file.writePixels(16);
    }
  }
}

void write_images(const std::filesystem::path& folder) {
  Bytes rgba;
  for (int i = 0; i < 16 * 16 * 4; ++i) rgba.push_back(std::uint8_t(i * i >> 5));
  const Bytes rgb(rgba.begin(), rgba.begin() + 16 * 16 * 3);
  const Bytes grey(rgba.begin(), rgba.begin() + 16 * 16);
  write(folder / "rgba.png", png(16, 16, 4, rgba));
  write(folder / "rgb.png", png(16, 16, 3, rgb));
  write(folder / "grey.png", png(16, 16, 1, grey));
  write(folder / "deep.png", png(8, 16, 4, rgba, 16));
  write(folder / "grey_alpha.png", png(16, 16, 2, Bytes(rgba.begin(), rgba.begin() + 512)));
  write(folder / "palette.png", palette_png());
  write(folder / "grey.jpg", other_jpeg(TJPF_GRAY, TJSAMP_GRAY, grey));
  write(folder / "cmyk.jpg", other_jpeg(TJPF_CMYK, TJSAMP_420, rgba));
  const std::string ktx = "\xabKTX 20\xbb\r\n\x1a\n";
  write(folder / "other.ktx2", Bytes(ktx.begin(), ktx.end()));
  write(folder / "baseline.jpg", jpeg(16, 16, rgb));
  write(folder / "progressive.jpg", jpeg(16, 16, rgb, true));
  write(folder / "lossless.webp", webp(16, 16, rgba));
  write(folder / "lossy.webp", webp(16, 16, rgba, false));
  write_textures(folder);
  write_environments(folder);
}

}  // namespace
}  // namespace heliograph::scene::test

int main(int count, char** arguments) {
  using namespace heliograph::scene::test;
  const std::string kind = count == 3 ? arguments[1] : "";
  if (kind == "gltf") {
    write_documents(arguments[2]);
  } else if (kind == "images") {
    write_images(arguments[2]);
  } else if (kind == "environments") {
    write_environments(arguments[2]);
  } else if (kind == "textures") {
    write_textures(arguments[2]);
  } else {
    std::fputs("usage: heliograph-fuzz-seeds gltf|images|environments|textures FOLDER\n", stderr);
    return 2;
  }
  return 0;
}
