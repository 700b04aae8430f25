#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "proto/error.h"
#include "proto/limits.h"
#include "proto/types.h"

namespace weft::proto {

/// Reads the fields of one JSON object and keeps the first error; after it every read does nothing.
/// So code reads a command without branches and checks for success once. An absent field and a null
/// are the same.
class FieldReader {
 public:
  /// @param object  a JSON object that outlives the reader
  explicit FieldReader(const nlohmann::json& object) : object_(object) {}

  bool ok() const { return !error_; }
  const std::optional<Error>& error() const { return error_; }
  bool has(const char* key) const { return find(key) != nullptr; }
  bool is_true(const char* key) const;

  // Required fields. On error `value` is unchanged.
  void read(const char* key, bool& value);
  void read(const char* key, double& value, Range range);
  void read(const char* key, std::uint32_t& value, Range range);
  void read(const char* key, Vec3& value, Range range);
  void read(const char* key, Quat& value, Range range);
  void read(const char* key, std::string& value);
  /// A string of 1 to kMostSceneBytes bytes, or an index.
  void read(const char* key, ColliderRef& value);

  /// The JSON text of an object field; false, with `text` untouched, if the field is not an object.
  bool read_object_text(const char* key, std::string& text);

  /// A word of a list; `value` becomes the enumerator at the same index.
  template <class Enum, std::size_t N>
  void read(const char* key, Enum& value, const std::array<const char*, N>& words) {
    std::string text;
    read(key, text);
    if (!ok()) return;
    for (std::size_t i = 0; i < N; ++i) {
      if (text == words[i]) {
        value = static_cast<Enum>(i);
        return;
      }
    }
    fail(word_error(key, text, {words.begin(), words.end()}));
  }

  /// The same for an optional field: without it `value` keeps its default.
  template <class Value, class... Allowed>
  void read_if_there(const char* key, Value& value, const Allowed&... allowed) {
    if (has(key)) read(key, value, allowed...);
  }
  template <class Value, class... Allowed>
  void read_if_there(const char* key, std::optional<Value>& value, const Allowed&... allowed) {
    if (!has(key)) return;
    Value present{};
    read(key, present, allowed...);
    if (ok()) value = std::move(present);
  }

  /// An object; errors name its field, as in "fabric.shear".
  void read_object(const char* key, const std::function<void(FieldReader&)>& read_it);

  /// An array of at most `most` objects; `read_one` gets a reader for each. Errors name the index,
  /// as in "fans[1].speed".
  void read_objects(const char* key, std::size_t most,
                    const std::function<void(FieldReader&)>& read_one);

  /// An array of at most `most` words of a list; `add` gets the place of each. Errors name the
  /// index, as in "observe[1]".
  void read_words(const char* key, std::size_t most, std::span<const char* const> words,
                  const std::function<void(std::size_t)>& add);

  /// An integer from 0 to 2^53 or a string of 1 to kMostIdBytes bytes; may be absent.
  void read_id(const char* key, std::optional<Id>& value);

  /// Keeps the error if it is the first.
  void fail(Error error);
  /// An error about one field, with its present value.
  void fail(ErrorCode code, const char* key, std::string message, std::string hint = {});
  /// The same for a wrong length, with the allowed ones.
  void fail_length(const char* key, Limit length, std::string message, std::string hint = {});

 private:
  void read_inner(const std::string& path, const nlohmann::json& node,
                  const std::function<void(FieldReader&)>& read_it);
  using ReadItem = std::function<void(const std::string& path, const nlohmann::json&)>;
  void read_list(const char* key, std::size_t most, const ReadItem& read_item);
  const nlohmann::json* find(const char* key) const;
  const nlohmann::json* require(const char* key);
  template <std::size_t N>
  void read_numbers(const char* key, std::array<double, N>& value, Range range);
  void read_number(const std::string& path, const nlohmann::json& node, double& value, Range range);
  void fail_type(std::string path, const nlohmann::json& node, const char* wanted);

  const nlohmann::json& object_;
  std::optional<Error> error_;
};

/// JSON text of a value for an error: always short.
std::string shown_value(const nlohmann::json& node);

}  // namespace weft::proto
