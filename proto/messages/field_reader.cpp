#include "proto/messages/field_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <nlohmann/json.hpp>

#include "proto/utf8.h"

namespace weft::proto {

using nlohmann::json;

std::string shown_value(const json& node) {
  if (node.is_string()) return quoted_value(node.get_ref<const std::string&>());
  if (!node.is_structured()) return node.dump();
  const std::string text = node.dump();
  return text.size() <= kMostValueCharacters ? text : quoted_value(text);
}

namespace {

/// Whether a double holds the number exactly as sent. 2^53 + 1 has none, and the nearest double
/// could be allowed where the number is not.
bool is_exact(const json& node) {
  constexpr auto kMost = static_cast<std::int64_t>(kLargestInteger);
  if (node.is_number_unsigned()) return node.get<std::uint64_t>() <= std::uint64_t{kMost};
  return !node.is_number_integer() || node.get<std::int64_t>() >= -kMost;
}

}  // namespace

const json* FieldReader::find(const char* key) const {
  const auto it = object_.find(key);
  return it == object_.end() || it->is_null() ? nullptr : &*it;
}

bool FieldReader::is_true(const char* key) const {
  const json* node = find(key);
  return node != nullptr && node->is_boolean() && node->get<bool>();
}

const json* FieldReader::require(const char* key) {
  if (!ok()) return nullptr;
  const json* node = find(key);
  if (node == nullptr) {
    fail(ErrorCode::missing_field, key, std::string(key) + " is missing");
  }
  return node;
}

void FieldReader::fail(Error error) {
  if (!error_) error_ = std::move(error);
}

void FieldReader::fail(ErrorCode code, const char* key, std::string message, std::string hint) {
  Error error = make_error(code, std::move(message), std::move(hint));
  error.field = key;
  if (const json* node = find(key)) error.value = shown_value(*node);
  fail(std::move(error));
}

void FieldReader::fail_length(const char* key, Limit length, std::string message,
                              std::string hint) {
  if (!ok()) return;
  fail(ErrorCode::wrong_length, key, std::move(message), std::move(hint));
  error_->limit = std::move(length);
}

void FieldReader::fail_type(std::string path, const json& node, const char* wanted) {
  Error error = make_error(ErrorCode::wrong_type, path + " must be " + wanted);
  error.field = std::move(path);
  error.value = shown_value(node);
  fail(std::move(error));
}

void FieldReader::read_number(const std::string& path, const json& node, double& value,
                              Range range) {
  if (!node.is_number()) return fail_type(path, node, "a number");
  const auto number = node.get<double>();
  // Written so that NaN, should one ever get here, is refused too.
  if (!is_exact(node) || !(number >= range.minimum && number <= range.maximum)) {
    Error error = range_error(path, number, range);
    error.value = shown_value(node);
    return fail(std::move(error));
  }
  value = number;
}

void FieldReader::read(const char* key, bool& value) {
  const json* node = require(key);
  if (node == nullptr) return;
  if (!node->is_boolean()) return fail_type(key, *node, "true or false");
  value = node->get<bool>();
}

void FieldReader::read(const char* key, double& value, Range range) {
  if (const json* node = require(key)) read_number(key, *node, value, range);
}

void FieldReader::read(const char* key, std::uint32_t& value, Range range) {
  const json* node = require(key);
  if (node == nullptr) return;
  double number = 0;
  read_number(key, *node, number, range);
  if (!ok()) return;
  if (number != std::floor(number)) return fail_type(key, *node, "an integer");
  value = static_cast<std::uint32_t>(number);
}

void FieldReader::read(const char* key, ColliderRef& value) {
  const json* node = require(key);
  if (node == nullptr) return;
  if (node->is_number()) {
    std::uint32_t index = 0;
    read(key, index, kIndexRange);
    if (ok()) value = index;
    return;
  }
  if (!node->is_string()) return fail_type(key, *node, "a name or an index");
  std::string name = node->get<std::string>();
  if (name.empty() || name.size() > kMostSceneBytes)
    return fail_length(key, {1.0, static_cast<double>(kMostSceneBytes), {}, {}},
                       std::string(key) + " must have 1 to 64 bytes",
                       "an object without a name is told by its index in the list of mesh");
  value = std::move(name);
}

template <std::size_t N>
void FieldReader::read_numbers(const char* key, std::array<double, N>& value, Range range) {
  const json* node = require(key);
  if (node == nullptr) return;
  const std::string wanted = std::to_string(N) + " numbers";
  if (!node->is_array()) return fail_type(key, *node, ("an array of " + wanted).c_str());
  if (node->size() != N)
    return fail_length(key, {{}, {}, N, {}}, std::string(key) + " must have " + wanted);
  std::array<double, N> read{};
  for (std::size_t i = 0; i < N && ok(); ++i)
    read_number(std::string(key) + "[" + std::to_string(i) + "]", (*node)[i], read[i], range);
  if (ok()) value = read;
}

void FieldReader::read(const char* key, Vec3& value, Range range) {
  read_numbers(key, value, range);
}

void FieldReader::read(const char* key, Quat& value, Range range) {
  read_numbers(key, value, range);
}

void FieldReader::read(const char* key, std::string& value) {
  const json* node = require(key);
  if (node == nullptr) return;
  if (!node->is_string()) return fail_type(key, *node, "a string");
  value = node->get_ref<const std::string&>();
}

bool FieldReader::read_object_text(const char* key, std::string& text) {
  const json* node = ok() ? find(key) : nullptr;
  if (!node || !node->is_object()) return false;
  text = node->dump();
  return true;
}

void FieldReader::read_inner(const std::string& path, const json& node,
                             const std::function<void(FieldReader&)>& read_it) {
  if (!node.is_object()) return fail_type(path, node, "an object");
  FieldReader inner(node);
  read_it(inner);
  if (inner.ok()) return;
  Error error = *inner.error();
  error.field = error.field.empty() ? path : path + "." + error.field;
  fail(std::move(error));
}

void FieldReader::read_object(const char* key, const std::function<void(FieldReader&)>& read_it) {
  if (const json* node = require(key)) read_inner(key, *node, read_it);
}

void FieldReader::read_list(const char* key, std::size_t most, const ReadItem& read_item) {
  const json* node = require(key);
  if (node == nullptr) return;
  if (!node->is_array()) return fail_type(key, *node, "an array");
  if (node->size() > most)
    return fail_length(
        key, {{}, static_cast<double>(most), {}, {}},
        std::string(key) + " must have at most " + std::to_string(most) + " entries");
  for (std::size_t k = 0; k < node->size() && ok(); ++k)
    read_item(std::string(key) + "[" + std::to_string(k) + "]", (*node)[k]);
}

void FieldReader::read_objects(const char* key, std::size_t most,
                               const std::function<void(FieldReader&)>& read_one) {
  read_list(key, most,
            [&](const std::string& path, const json& node) { read_inner(path, node, read_one); });
}

void FieldReader::read_words(const char* key, std::size_t most, std::span<const char* const> words,
                             const std::function<void(std::size_t)>& add) {
  read_list(key, most, [&](const std::string& path, const json& node) {
    if (!node.is_string()) return fail_type(path, node, "a string");
    const auto& word = node.get_ref<const std::string&>();
    const auto found = std::find(words.begin(), words.end(), word);
    if (found == words.end()) return fail(word_error(path, word, {words.begin(), words.end()}));
    add(static_cast<std::size_t>(found - words.begin()));
  });
}

void FieldReader::read_id(const char* key, std::optional<Id>& value) {
  const json* node = find(key);
  if (node == nullptr) return;
  if (node->is_string()) {
    const auto& text = node->get_ref<const std::string&>();
    if (text.empty() || text.size() > kMostIdBytes)
      return fail_length(key, {1.0, static_cast<double>(kMostIdBytes), {}, {}},
                         "id must have 1 to 64 bytes");
    value = text;
  } else {
    double number = 0;
    read_number(key, *node, number, {0, kLargestInteger});
    if (!ok()) return;
    if (number != std::floor(number)) return fail_type(key, *node, "an integer or a string");
    value = static_cast<std::int64_t>(number);
  }
}

}  // namespace weft::proto
