// Arrays of numbers in source text: what headers, modules and data files hold of a table.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ltcfit {

struct TextArray {
  std::string name;
  /// As declared behind the name (C), 0 for what is no number; else as its brackets nest, where all of a
  /// depth are of one length. Empty for a flat list.
  std::vector<std::size_t> shape;
  std::vector<float> values;  ///< in the order of the text, nesting removed
  bool isMember = false;      ///< `name: [..]` of an object, not `name = ..`
};

/// An array that broke off.
struct DamagedArray {
  std::string name;
  std::size_t numbers = 0;  ///< read before the place
  std::string found;        ///< a few printable characters of what is there; empty at the end of the text
};

/// Every array of numbers in a text, comments inside of it skipped:
///   C, C++, C#: `NAME[n]..[m] = {..}`, `T[] NAME = new T[n] {..}`
///   JavaScript, TypeScript: `NAME: TYPE = [..]`, `new Float32Array([..])`, `Float32Array.of(..)`, `NAME:
///   [..]` Rust: `NAME: [T; n] = [..]`, `&[..]`, suffixes as in 1.0_f32 JSON: `"NAME": [..]`
/// Numbers are decimal or, for 16 bits, hexadecimal. An initialiser with anything else in it is left out;
/// where it began with a number, it goes to `damaged`: cut off, or a number that is none any more. Takes any
/// bytes and ends after one pass over them.
std::vector<TextArray> arraysOfText(std::string_view text, std::vector<DamagedArray>* damaged = nullptr);

}  // namespace ltcfit
