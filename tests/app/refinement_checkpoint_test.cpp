// A checkpoint is read back to the same doubles, or refused: never taken for another state.
#include "app/refinement_checkpoint.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "export/atomic_file.h"

namespace ltcfit::app {
namespace {

class RefinementCheckpointTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("ltcfit-checkpoint-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    path_ = (folder_ / "t.json.part").string();
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // Why the file is refused; empty where it is not.
  std::string refusal(const std::string& fingerprint = "run") const {
    try {
      const RefinementCheckpoint read(path_, fingerprint, true);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }

  std::filesystem::path folder_;
  std::string path_;
};

RefinementState someState() {
  return {7, 1.0 / 3.0, 2.0517, {0.1, -1e-300, 0.0, 5e-324, 1.7976931348623157e308, -2.0 / 7.0}};
}

TEST_F(RefinementCheckpointTest, ReadsBackTheSameNumbers) {
  const RefinementCheckpoint fresh(path_, "run", true);
  EXPECT_EQ(fresh.found(), nullptr);
  fresh.save(someState());
  const RefinementCheckpoint read(path_, "run", true);
  ASSERT_NE(read.found(), nullptr);
  EXPECT_EQ(read.found()->iterations, 7);
  EXPECT_EQ(read.found()->radius, 1.0 / 3.0);
  EXPECT_EQ(read.found()->cost, 2.0517);
  EXPECT_EQ(read.found()->parameters, someState().parameters);
  read.remove();
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(RefinementCheckpointTest, IsRefusedWithoutResumeAndByAnotherRun) {
  RefinementCheckpoint(path_, "run", false).save(someState());
  EXPECT_THROW(RefinementCheckpoint(path_, "run", false), InputError);
  EXPECT_NE(refusal("another").find("holds another run, of: run"), std::string::npos);
  EXPECT_EQ(refusal("run"), "");
}

TEST_F(RefinementCheckpointTest, CutOffAnywhereIsRefused) {
  RefinementCheckpoint(path_, "run", false).save(someState());
  const std::string whole = readFile(path_);
  for (std::size_t n = 0; n < whole.size(); ++n) {
    writeFileAtomically(path_, whole.substr(0, n));
    EXPECT_NE(refusal(), "") << n;
  }
  writeFileAtomically(path_, whole + "1");
  EXPECT_NE(refusal(), "");
}

TEST_F(RefinementCheckpointTest, AnyBitFlippedIsRefused) {
  RefinementCheckpoint(path_, "run", false).save(someState());
  const std::string whole = readFile(path_);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string changed = whole;
      changed[i] = static_cast<char>(static_cast<unsigned char>(changed[i]) ^ (1u << bit));
      writeFileAtomically(path_, changed);
      EXPECT_NE(refusal(), "") << i << " " << bit;
    }
  }
}

TEST_F(RefinementCheckpointTest, WhatIsNoFileIsRefused) {
  std::filesystem::create_directory(path_);
  EXPECT_NE(refusal().find("not a file"), std::string::npos);
}

}  // namespace
}  // namespace ltcfit::app
