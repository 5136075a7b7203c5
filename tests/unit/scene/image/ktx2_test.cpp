#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "scene/image/image_decoder.hpp"
#include "scene/image/ktx2/uastc.hpp"
#include "scene/import_error.hpp"
#include "tests/unit/scene/support/ktx2_files.hpp"

namespace heliograph::scene::test {
namespace {

using nlohmann::json;

struct UastcBlock {
  std::string_view block;
  std::string_view texels;  // of Khronos' transcoder
};

/// A random block of every mode, 0 to 18.
constexpr UastcBlock blocks_of_modes[] = {
    {"31a9d82791a5b613e042c9c3527760e6",
     "ed24c7ff6e9f10ffdc34afffc94793ff9b7450ff7f8e28ffd43ca3ff7f8e28ff"
     "dc34afffc14f87ffb05f6fffb05f6fffed24c7ffb8577bffb8577bff6e9f10ff"},
    {"f5630caca3e9ddb3723cd9b47fb32446",
     "4a829bff4a829bff604d9eff1def95ff1def95ff604d9eff4a829bff33ba98ff"
     "4a829bff1def95ff604d9eff4a829bff1def95ff33ba98ff1def95ff1def95ff"},
    {"9da79e36ad5352063db63ed16686bc70",
     "675791ff327c30ffb28778ff9ecd32ff228811ffa7ab54ffbb6699ffa3bc43ff"
     "a3bc43ffb67788ffad9867ff9ecd32ffbb6699ffb28778ff9ecd32ffad9867ff"},
    {"43bc67f9e80db28ba08c02f48df48fad",
     "ffff00ff63ab0fff2ed15cff17d1e8ff8bffe8ff63ab0fff17d1e8ff2ed15cff"
     "b1ff9cff17ff00ff26d18aff17d1e8ff8bffe8ffff002eff17d1e8ff2ed15cff"},
    {"f3d8268da72bbf68687285100e565041",
     "beb14eff4ecb1aff4eb12fff4ecb1affbeb14eff1ae568ff4ebe24ff4ecb1aff"
     "beb14eff1ae568ff50d45fff4eb12fffbeb14effbeb14eff50d45fff50d45fff"},
    {"6bb99fae565596d47a84c06d9fc3df97",
     "b45c73ffd75757ffc65965ffe95549ffd75757ffe95549ff7c639fff8e6091ff"
     "8e6091ff8e6091ff6a65adffd75757ff6a65adffe95549ff7c639fff6a65adff"},
    {"5b45fa65ab29d246a3d8236509ba618f",
     "6c201cff5d5152ff6c201cff653836ff56696cff5d5152ff653836ff5d5152ff"
     "653836ff6c201cff5d5152ff56696cff653836ff5d5152ff56696cff6c201cff"},
    {"0757ce04dc38b75571c731559afce7a8",
     "b12013ff9ea26affc9cb5fffc9cb5fffb12013ffb54f3afff2f254ff757b75ff"
     "b54f3affba8163ffbeb18affbeb18affbeb18affbeb18affb12013ffbeb18aff"},
    {"f7864a58e4315d4e030fd065b0986ba8",
     "3754c2223754c2223754c2223754c2223754c2223754c2223754c2223754c222"
     "3754c2223754c2223754c2223754c2223754c2223754c2223754c2223754c222"},
    {"0fa99a55a7c57bb916a02d34f236cad4",
     "7e484a78bb0066aa00dd111100dd11113d952d437e484a7800dd1111bb0066aa"
     "3322ddcc7e484a787e484a783d952d436b65d2a5a5abc67c3d952d433d952d43"},
    {"9242b15d099736092761fe7bb469d372",
     "2796a82d249ea72a22a6a5282f7bae354333bd49462bbe4c3c4eb7423173af37"
     "2a8baa303c4eb742375eb43d2f7bae352796a82d413bbb47249ea72a3173af37"},
    {"306c0ba70229b6802f4721b6f7d12a97",
     "114f6f2c19513e55204f107c0b4f9e0511516f2c19513e55194f3e55204d107c"
     "204f107c204c107c11516f2c114c6f2c194d3e5519513e55204f107c114d6f2c"},
    {"b6294348e7a2a6e33c4ad1304ffdb3c2",
     "9b959edfb58999d1c18297ca9b959edfc18297cae96f8fb4c18297cab58999d1"
     "dc7592bbf5698dadf5698dada88f9cd8c18297cadc7592bb9b959edfe96f8fb4"},
    {"bf8664f2c7c5dc34e1c5a843f1302e23",
     "1f7384a317d317a317d317a31f7384a317d3170e17d3170e1f7384a31f7384a3"
     "17d3170e1f7384a31f73840e17d3170e1f73840e1f7384a317d3170e1f7384a3"},
    {"cd2e0206cd3df6bf19d67eb2ccd18262",
     "d49688acd49688acd49688acd8cc7468d49688acd8cc7468dcff6127d0639bed"
     "d8cc7468d8cc7468d49688acd49688acd0639bedd0639bedd49688acd49688ac"},
    {"057c589191ce34eca243b6e55b66ea9f",
     "444444cd454545d13b3b3bb5454545d1444444cf3d3d3dba3b3b3bb5444444cf"
     "3a3a3ab03b3b3bb5444444cf444444cd444444cd424242c83a3a3ab03a3a3ab0"},
    {"95f12d0ca6bc80b51aa7eb622949cbeb",
     "c6c6c6ba2b2b2b792d2d2d9429292960d2d2d29adedede78c6c6c6ba2b2b2b79"
     "e9e9e958dedede78c6c6c6bae9e9e958e9e9e958dedede78dedede78e9e9e958"},
    {"25f55896b5dce2830446b4a0203706a1",
     "acacac16bfbfbf1cacacac16acacac1facacac1cacacac1cd3d3d319bfbfbf16"
     "acacac19bfbfbf16acacac19d3d3d31fd3d3d319acacac1facacac16d3d3d316"},
    {"39692216d4d09c45d960de093f0bde03",
     "624b33ff58412dff74613fff796743ff5d4630ff705c3cff998d58ffa3975eff"
     "4a3023ff958755ff665136ff8b7c4fff210008ff665136ff665136ff210008ff"},
};

Bytes from_hex(std::string_view digits) {
  Bytes bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    bytes.push_back(
        static_cast<std::uint8_t>(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16)));
  }
  return bytes;
}

Bytes decoded(const Bytes& file) {
  const ImageSize size = probe_image(file);
  Bytes rgba(std::size_t(size.width) * size.height * 4);
  decode_image(file, size, rgba);
  return rgba;
}

/// A block of one colour.
Bytes solid_block(std::array<std::uint8_t, 4> color) {
  Bytes block(16, 0);
  block[0] = 0x17;
  for (std::size_t i = 0; i < 4; ++i) {
    block[i] = static_cast<std::uint8_t>(block[i] | color[i] << 5);
    block[i + 1] = color[i] >> 3;
  }
  return block;
}

TEST(Uastc, BlocksOfEveryModeDecodeToTheTexelsOfTheReference) {
  for (const auto& [block, texels] : blocks_of_modes) {
    const Bytes bytes = from_hex(block);
    const auto got = ktx2::decode_uastc(std::span<const std::uint8_t, 16>(bytes), false);
    EXPECT_EQ(Bytes(got.begin(), got.end()), from_hex(texels)) << block;
  }
}

TEST(Uastc, InvalidBlocksAreMagenta) {
  for (const std::string_view block :
       {"45000000000000000000000000000000", "1d00f001000000000000000000000000"}) {
    const Bytes bytes = from_hex(block);
    const auto got = ktx2::decode_uastc(std::span<const std::uint8_t, 16>(bytes), false);
    EXPECT_EQ(Bytes(got.begin(), got.begin() + 4), (Bytes{255, 0, 255, 255})) << block;
  }
}

TEST(Ktx2, BlocksBeyondTheEdgeAreCut) {
  Bytes blocks = solid_block({10, 20, 30, 40});
  const Bytes second = solid_block({250, 150, 50, 255});
  blocks.insert(blocks.end(), second.begin(), second.end());
  for (const bool zstandard : {false, true}) {
    const Bytes file = ktx2_of_blocks(5, 3, blocks, zstandard);
    EXPECT_EQ(probe_image(file), (ImageSize{5, 3}));
    const Bytes rgba = decoded(file);
    for (std::size_t y = 0; y < 3; ++y) {
      EXPECT_EQ(Bytes(rgba.begin() + 20 * y, rgba.begin() + 20 * y + 4), (Bytes{10, 20, 30, 40}));
      EXPECT_EQ(Bytes(rgba.begin() + 20 * y + 16, rgba.begin() + 20 * y + 20),
                (Bytes{250, 150, 50, 255}));
    }
  }
}

TEST(Ktx2, Etc1sIsCloseToItsSource) {
  const Bytes file = ktx2_of_etc1s();
  ASSERT_EQ(probe_image(file), (ImageSize{14, 10}));
  const Bytes rgba = decoded(file);
  std::array<double, 4> difference{};
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 14; ++x) {
      const auto source = etc1s_texel(x, y);
      for (std::size_t i = 0; i < 4; ++i) {
        difference[i] += std::abs(rgba[std::size_t(y * 14 + x) * 4 + i] - source[i]) / 140.0;
      }
    }
  }
  // ETC1S has one hue per block, but alpha in a plane of its own.
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(difference[i], 25.0) << i;
  EXPECT_LT(difference[3], 4.0);
}

TEST(Ktx2, WhatTheExtensionDoesNotPermitIsRefused) {
  const Bytes good = ktx2_of_blocks(4, 4, solid_block({1, 2, 3, 4}));
  const auto with = [&](std::size_t offset, std::uint8_t value) {
    Bytes file = good;
    file[offset] = value;
    return file;
  };
  for (const Bytes& file : {with(28, 2), with(32, 2), with(36, 6), with(44, 1), with(44, 3),
                            with(116, 163), with(116, 131), with(88, 255), with(81, 255)}) {
    EXPECT_THROW(decoded(file), ImportError);
  }
}

TEST(Ktx2, DamageIsRefusedOrDecoded) {
  std::mt19937 random(11);
  const Bytes uastc = ktx2_of_blocks(4, 4, solid_block({1, 2, 3, 4}), true);
  for (const Bytes& good : {ktx2_of_etc1s(), uastc}) {
    for (std::size_t size = 0; size < good.size(); ++size) {
      EXPECT_ANY_THROW(decoded(Bytes(good.begin(), good.begin() + size))) << size;
    }
    for (int round = 0; round < 3000; ++round) {
      Bytes file = good;
      for (int i = 0; i < 3; ++i) {
        // Not the size: a small file may have a large image.
        file[28 + random() % (file.size() - 28)] = static_cast<std::uint8_t>(random());
      }
      try {
        decoded(file);
      } catch (const ImportError& refusal) {
        EXPECT_NE(std::string(refusal.what()), "");
      }
    }
  }
}

TEST(Ktx2, TexturesMayRequireIt) {
  GltfBuilder builder = everything();
  builder.json["extensionsUsed"].push_back("KHR_texture_basisu");
  builder.json["extensionsRequired"] = {"KHR_texture_basisu"};
  const auto image = builder.add_image(ktx2_of_blocks(8, 4, [] {
    Bytes blocks = solid_block({200, 100, 50, 255});
    const Bytes second = blocks;
    blocks.insert(blocks.end(), second.begin(), second.end());
    return blocks;
  }()));
  builder.json["textures"][0] = {{"extensions", {{"KHR_texture_basisu", {{"source", image}}}}}};
  const Scene scene = builder.import(strict_limits);
  const Image& read = scene.images.at(0);
  EXPECT_EQ(read.width, 8u);
  EXPECT_EQ(Bytes(read.pixels.begin(), read.pixels.begin() + 4), (Bytes{200, 100, 50, 255}));
}

}  // namespace
}  // namespace heliograph::scene::test
