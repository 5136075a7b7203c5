#include <gtest/gtest.h>

#include "tests/support/engine.hpp"

namespace {

/// Fails every test during which the validation layers report a message.
class ValidationWatch : public testing::EmptyTestEventListener {
 public:
  void OnTestEnd(const testing::TestInfo&) override {
    const std::uint64_t messages = heliograph::test::validation_messages();
    if (messages != seen_) ADD_FAILURE() << "the validation layers complained (see above)";
    seen_ = messages;
  }
  void OnTestProgramEnd(const testing::UnitTest&) override { heliograph::test::release_engines(); }

 private:
  std::uint64_t seen_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  testing::UnitTest::GetInstance()->listeners().Append(new ValidationWatch);
  return RUN_ALL_TESTS();
}
