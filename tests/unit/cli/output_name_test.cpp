#include "cli/render/output/output_name.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace heliograph::cli {
namespace {

const ImageOf image{.scene = "fox", .camera = "top view", .frame = 7};

std::string name(const std::string& text) {
  return OutputName(text).file(image).string();
}

TEST(OutputName, PlaceholdersStandForWhatIsInTheImage) {
  EXPECT_EQ(name("out.png"), "out.png");
  EXPECT_EQ(name("a/{scene}_{camera}_{frame:05}.png"), "a/fox_top view_00007.png");
  EXPECT_EQ(name("{frame}.png"), "0007.png");
  EXPECT_EQ(name("/tmp/run_%05d.png"), "/tmp/run_00007.png");
  EXPECT_EQ(name("run_%d.png"), "run_7.png");
  EXPECT_EQ(name("{{%%}}_100%.png"), "{%}_100%.png");
}

TEST(OutputName, TellsWhichPlaceholdersItHas) {
  const OutputName all("{scene}{camera}%d.png");
  EXPECT_TRUE(all.has_scene() && all.has_camera() && all.has_frame());
  const OutputName none("scene.png");
  EXPECT_FALSE(none.has_scene() || none.has_camera() || none.has_frame());
  EXPECT_TRUE(OutputName("-").is_standard_output());
  EXPECT_FALSE(OutputName("-.png").is_standard_output());
}

TEST(OutputName, FramesAreNumberedBeforeTheExtension) {
  for (const auto& [text, numbered] :
       {std::pair{"a.b/run.tar.png", "a.b/run.tar_0007.png"}, std::pair{"run", "run_0007"},
        std::pair{"{scene}", "fox_0007"}, std::pair{"x{scene}.png", "xfox_0007.png"}}) {
    OutputName output(text);
    output.add_frame();
    EXPECT_EQ(output.file(image).string(), numbered);
  }
}

TEST(OutputName, NamesOfAFileStayInItsFolder) {
  const OutputName output("out/{scene}_{camera}.png");
  EXPECT_EQ(output.file({.scene = "..", .camera = "../../etc\n"}).string(),
            "out/.._.._.._etc_.png");
  EXPECT_EQ(output.folder(), "out/");
  const OutputName folders("out/{scene}/{camera}/{frame:04}.png");
  EXPECT_EQ(folders.file({.scene = "fox", .camera = ".."}).string(), "out/fox/_/0000.png");
  EXPECT_EQ(folders.folder(), "out/");
  EXPECT_EQ(folders.extension(), ".png");
  EXPECT_EQ(OutputName("{scene}.d/{camera}").extension(), "");
}

TEST(OutputName, WhatIsNoNameIsRefused) {
  for (const char* const text : {"{scen}.png", "{frame:}.png", "{frame:x}.png", "{frame:99}.png",
                                 "{scene.png", "a/", ".", "{scene}/", "%0999d.png", ""}) {
    EXPECT_THROW(OutputName{text}, std::invalid_argument) << text;
  }
}

TEST(OutputName, GivesTheExtension) {
  EXPECT_EQ(OutputName("a.PNG").extension(), ".PNG");
  EXPECT_EQ(OutputName("a.png/b").extension(), "");
  EXPECT_EQ(OutputName(".png").extension(), "");
  EXPECT_EQ(OutputName("{scene}.exr").extension(), ".exr");
}

}  // namespace
}  // namespace heliograph::cli
