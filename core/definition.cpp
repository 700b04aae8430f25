// Checks, parses and lists fields of definitions.

#include "core/definition.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string_view>

#include "core/error.h"

namespace weft {
namespace {

double parse_number(const std::string& field, const FieldInfo& info, std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(text.data(), end, value);
  if (status != std::errc() || stop != end || !std::isfinite(value))
    throw DefinitionError(field, std::string(text), allowed_values(info), "a finite number");
  return value;
}

/// Number of single-character edits between two words; finds the intended key.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

std::string number_text(double value) {
  char buffer[32];
  const auto [stop, status] = std::to_chars(buffer, buffer + sizeof buffer, value);
  return status == std::errc() ? std::string(buffer, stop) : std::string("?");
}

std::string rounded_text(double value, int digits) {
  assert(digits >= 1);
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.*g", digits, value);
  return buffer;
}

FieldInfo choice(const char* name, const char* words, const char* meaning) {
  assert(name && words && *words != '\0');
  const std::string_view all = words;
  const auto bars = std::count(all.begin(), all.end(), '|');
  return {name, 0, static_cast<double>(bars), "", meaning, words};
}

std::string choice_word(const FieldInfo& info, int value) {
  assert(info.words && "a choice");
  assert(value >= 0);
  std::string_view rest = info.words;
  for (int k = 0; k < value && !rest.empty(); ++k) {
    const std::size_t bar = rest.find('|');
    rest.remove_prefix(bar == std::string_view::npos ? rest.size() : bar + 1);
  }
  return std::string(rest.substr(0, rest.find('|')));
}

int parse_choice(const std::string& path, const FieldInfo& info, const std::string& text) {
  assert(info.words && "a choice");
  for (int value = 0; value <= static_cast<int>(info.range.maximum); ++value) {
    if (choice_word(info, value) == text) return value;
  }
  throw DefinitionError(path + info.name, text, allowed_values(info), info.meaning);
}

std::string allowed_values(const FieldInfo& info) {
  if (info.words) {
    std::string text;
    const int last = static_cast<int>(info.range.maximum);
    for (int value = 0; value <= last; ++value)
      text += (value == 0 ? "" : value == last ? " or " : ", ") + choice_word(info, value);
    return text;
  }
  std::string text = number_text(info.range.minimum) + " to " + number_text(info.range.maximum);
  if (*info.unit) text += std::string(" ") + info.unit;
  return text;
}

void check_field(const std::string& path, const FieldInfo& info, double value) {
  assert(info.range.minimum <= info.range.maximum);
  // Written so that NaN fails too.
  if (!(value >= info.range.minimum && value <= info.range.maximum))
    throw DefinitionError(path + info.name, number_text(value), allowed_values(info), info.meaning);
}

void check_field(const std::string& path, const FieldInfo& info, int value) {
  check_field(path, info, static_cast<double>(value));
}

void check_field(const std::string&, const FieldInfo&, bool) {}

void check_field(const std::string& path, const FieldInfo& info, const Vec3d& value) {
  assert(info.range.minimum <= info.range.maximum);
  static constexpr const char* kAxes[] = {"[0]", "[1]", "[2]"};
  for (int axis = 0; axis < 3; ++axis) {
    if (!(value[axis] >= info.range.minimum && value[axis] <= info.range.maximum))
      throw DefinitionError(path + info.name + kAxes[axis], number_text(value[axis]),
                            allowed_values(info), info.meaning);
  }
}

void parse_field(const std::string& path, const FieldInfo& info, const std::string& text,
                 double& value) {
  const double parsed = parse_number(path + info.name, info, text);
  check_field(path, info, parsed);
  value = parsed;
}

void parse_field(const std::string& path, const FieldInfo& info, const std::string& text,
                 int& value) {
  const double parsed = parse_number(path + info.name, info, text);
  check_field(path, info, parsed);
  if (parsed != std::floor(parsed))
    throw DefinitionError(path + info.name, text, allowed_values(info), "a whole number");
  value = static_cast<int>(parsed);
}

void parse_field(const std::string& path, const FieldInfo& info, const std::string& text,
                 bool& value) {
  if (text != "true" && text != "false")
    throw DefinitionError(path + info.name, text, "true or false", info.meaning);
  value = text == "true";
}

void parse_field(const std::string& path, const FieldInfo& info, const std::string& text,
                 Vec3d& value) {
  Vec3d parsed = Vec3d::Zero();
  std::string_view rest = text;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t comma = rest.find(',');
    if ((axis < 2) != (comma != std::string_view::npos))
      throw DefinitionError(path + info.name, text, "three numbers as x,y,z", info.meaning);
    parsed[axis] = parse_number(path + info.name, info, rest.substr(0, comma));
    if (axis < 2) rest.remove_prefix(comma + 1);
  }
  check_field(path, info, parsed);
  value = parsed;
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& words) {
  std::string nearest;
  std::size_t best = word.size() / 2 + 1;
  for (const std::string& candidate : words) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance >= best) continue;
    best = distance;
    nearest = candidate;
  }
  return nearest;
}

}  // namespace weft
