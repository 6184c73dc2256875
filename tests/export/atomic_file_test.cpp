#include "export/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <string>

#include "export/temporary_file.h"

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

TEST_F(AtomicFile, TemporaryNamesAreNeverTheSame) {
  std::set<std::string> names;
  for (int i = 0; i < 1000; ++i) names.insert(internal::randomTemporaryName());
  EXPECT_EQ(names.size(), 1000u);
  for (const std::string& name : names) {
    EXPECT_EQ(name.size(), 24u);
    EXPECT_EQ(name.substr(0, 8), ".ltcfit-");
  }
}

// Both ways of making temporary files, with the names "0", "1", ...
class TemporaryFile : public AtomicFile, public ::testing::WithParamInterface<bool> {
 protected:
  internal::TemporaryFiles counted() const {
    return {.name = [next = 0]() mutable { return std::to_string(next++); }, .unnamed = GetParam()};
  }
  void replace(const fs::path& path, std::string_view bytes, const internal::TemporaryFiles& files) const {
    const mode_t mode = 0644;
    internal::replaceFile(path.string(), bytes, fs::exists(path) ? std::optional(mode) : std::nullopt, files);
  }
};

INSTANTIATE_TEST_SUITE_P(Files, TemporaryFile, ::testing::Bool(),
                         [](const auto& kind) { return kind.param ? "Unnamed" : "Named"; });

TEST_P(TemporaryFile, NamesThatAreTakenAreLeftAlone) {
  const fs::path victim = folder_ / "victim";
  std::ofstream(victim) << "another's";
  std::ofstream(folder_ / "0") << "another run's";
  fs::create_symlink(victim, folder_ / "1");
  fs::create_symlink(folder_ / "nothing", folder_ / "2");
  fs::create_directory(folder_ / "3");
  std::ofstream(folder_ / "table") << "old";
  replace(folder_ / "table", "new", counted());
  EXPECT_EQ(readFile(folder_ / "table"), "new");
  EXPECT_EQ(readFile(folder_ / "0"), "another run's");
  EXPECT_EQ(readFile(victim), "another's");
  EXPECT_TRUE(fs::is_symlink(folder_ / "1"));
  EXPECT_FALSE(fs::exists(folder_ / "nothing"));
  EXPECT_EQ(filesInFolder(), 6u) << "victim, 0, 1, 2, 3, table";
}

TEST_P(TemporaryFile, WithoutAFreeNameTheOldFileStays) {
  std::ofstream(folder_ / "0") << "another run's";
  std::ofstream(folder_ / "table") << "old";
  const internal::TemporaryFiles one{.name = [] { return std::string("0"); }, .unnamed = GetParam()};
  EXPECT_THROW(replace(folder_ / "table", "new", one), FileError);
  EXPECT_EQ(readFile(folder_ / "table"), "old");
  EXPECT_EQ(readFile(folder_ / "0"), "another run's");
  EXPECT_EQ(filesInFolder(), 2u);
}

// Two processes that would take the same names, as two containers of one process number did.
TEST_P(TemporaryFile, PairsOfWritersLoseAndMixNothing) {
  for (int pair = 0; pair < 100; ++pair) {
    const std::string number = std::to_string(pair);
    // files of their own, and one that both write
    const std::array<std::string, 2> bytes{std::string(100000, 'a') + number,
                                           std::string(100000, 'b') + number};
    int gate[2];
    ASSERT_EQ(::pipe(gate), 0);
    std::array<pid_t, 2> writers{};
    for (std::size_t w = 0; w < 2; ++w) {
      writers[w] = ::fork();
      ASSERT_GE(writers[w], 0);
      if (writers[w] > 0) continue;
      try {
        ::close(gate[1]);
        char open = 0;
        if (::read(gate[0], &open, 1) != 0) ::_exit(2);
        internal::TemporaryFiles files = counted();
        replace(folder_ / ("own-" + std::to_string(w)), bytes[w], files);
        replace(folder_ / "shared", bytes[w], files);
      } catch (...) {
        ::_exit(1);
      }
      ::_exit(0);
    }
    ::close(gate[0]);
    ::close(gate[1]);  // both go at once
    for (const pid_t writer : writers) {
      int status = 0;
      ASSERT_EQ(::waitpid(writer, &status, 0), writer);
      ASSERT_EQ(status, 0) << "pair " << pair;
    }
    for (std::size_t w = 0; w < 2; ++w)
      ASSERT_TRUE(readFile(folder_ / ("own-" + std::to_string(w))) == bytes[w]) << "pair " << pair;
    const std::string shared = readFile(folder_ / "shared");
    ASSERT_TRUE(shared == bytes[0] || shared == bytes[1]) << "pair " << pair;
    ASSERT_EQ(filesInFolder(), 3u) << "pair " << pair;
  }
}

}  // namespace
}  // namespace ltcfit
