#include "export/atomic_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace ltcfit {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public ::testing::Test {
 protected:
  AtomicFile() {
    char name[] = "/tmp/ltcfit-test-XXXXXX";
    folder_ = ::mkdtemp(name);
  }
  ~AtomicFile() override { fs::remove_all(folder_); }

  std::size_t filesInFolder() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

TEST_F(AtomicFile, WritesAndReplaces) {
  const std::string path = folder_ / "a.txt";
  writeFileAtomically(path, "first");
  writeFileAtomically(path, std::string("second\0with zero", 16));
  EXPECT_EQ(readFile(path), std::string("second\0with zero", 16));
  EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(AtomicFile, AFailedWriteLeavesNothing) {
  EXPECT_THROW(writeFileAtomically(folder_ / "no" / "such", "x"), FileError);
  fs::create_directory(folder_ / "taken");
  EXPECT_THROW(writeFileAtomically(folder_ / "taken", "x"),
               FileError);  // a folder is in the way of the rename
  EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(AtomicFile, WritabilityIsAskedFirst) {
  EXPECT_NO_THROW(checkWritable(folder_ / "new.json"));
  EXPECT_THROW(checkWritable(folder_), InputError);
  EXPECT_THROW(checkWritable(folder_ / "no" / "such"), InputError);
  EXPECT_THROW(checkWritable(""), InputError);
  EXPECT_EQ(filesInFolder(), 0u);
}

TEST_F(AtomicFile, LinksAndPermissionsStay) {
  const fs::path target = folder_ / "target";
  writeFileAtomically(target, "old");
  fs::permissions(target, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink(target, folder_ / "link");
  writeFileAtomically(folder_ / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(readFile(target), "new");
  EXPECT_EQ(fs::status(target).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(filesInFolder(), 2u);
}

TEST_F(AtomicFile, DevicesAreWrittenToNotReplaced) {
  EXPECT_NO_THROW(checkWritable("/dev/null"));
  writeFileAtomically("/dev/null", "x");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_THROW(writeFileAtomically("/dev/full", "x"), FileError);  // a full disk is an error
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(AtomicFile, ReadingWhatIsNotThere) {
  EXPECT_THROW(readFile(folder_ / "nothing"), InputError);
  EXPECT_THROW(readFile(folder_), InputError);
  std::ofstream(folder_ / "big") << std::string(100, 'x');
  EXPECT_THROW(readFile(folder_ / "big", 99), InputError);
  EXPECT_EQ(readFile(folder_ / "big", 100).size(), 100u);
}

}  // namespace
}  // namespace ltcfit
