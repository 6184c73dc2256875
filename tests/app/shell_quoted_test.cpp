#include "app/shell_quoted.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

namespace ltcfit::app {
namespace {

// What a shell makes of a command line: its words, as printf gets them, each between brackets.
std::string wordsOf(const std::string& arguments) {
  // in a folder with files, so that patterns would match
  const std::string command = "cd / && printf '[%s]' " + arguments;
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return "no shell";
  std::string out;
  for (int c = 0; (c = std::fgetc(pipe)) != EOF;) out += static_cast<char>(c);
  return ::pclose(pipe) == 0 ? out : "the shell failed: " + out;
}

TEST(ShellQuoted, AShellReadsTheSameBytesBack) {
  const std::vector<std::string> nasty{"",         " ",         "two words",
                                       "it's",     "'",         "''",
                                       "\"",       "a\"b'c",    "$HOME",
                                       "${HOME}",  "$(echo x)", "`echo x`",
                                       "a;echo x", "a&echo x",  "a|cat",
                                       "a>b",      "*",         "e?c",
                                       "[a-z]tc",  "~",         "~root",
                                       "#comment", "!",         "a\\b",
                                       "\\",       "a\nb",      "\t",
                                       "{a,b}",    "(a)",       "-n",
                                       "--",       "%s",        "\xc3\xa4.json",
                                       "\xff"};
  std::string all;
  std::string expected;
  for (const std::string& word : nasty) {
    EXPECT_EQ(wordsOf("x " + shellQuoted(word)), "[x][" + word + "]");
    all += " " + shellQuoted(word);
    expected += "[" + word + "]";
  }
  EXPECT_EQ(wordsOf("x" + all), "[x]" + expected);
}

TEST(ShellQuoted, PlainArgumentsStayAsTheyAre) {
  for (const char* const plain : {"ltc_iso.json", "64x64", "alpha=sqrt,theta=linear:0.3:-0.1", "1e-05", "-1",
                                  "theta=knots:0:30:60", "a+b@c%d", "../x/y"})
    EXPECT_EQ(shellQuoted(plain), plain);
}

TEST(ShellQuoted, FileNamesLoseTheirFolderAndAreNoOptions) {
  EXPECT_EQ(shellFileName("/tmp/some where/t.json"), "t.json");
  EXPECT_EQ(shellFileName("folder/my table.json"), "'my table.json'");
  EXPECT_EQ(shellFileName("-o.json"), "./-o.json");
  EXPECT_EQ(shellFileName("folder/-o $x"), "'./-o $x'");
}

}  // namespace
}  // namespace ltcfit::app
