#include <algorithm>
#include <cstddef>
#include <string>

#include <nlohmann/json.hpp>

#include "proto/messages/commands.h"
#include "proto/messages/field_reader.h"

namespace weft::proto {
namespace {

using nlohmann::json;

constexpr const char* kSpace = " \t\n\r";
constexpr std::size_t kMostEscapedByte = 6;  // as in \u0061
constexpr std::size_t kMostIdText = kMostEscapedByte * kMostIdBytes + 2;

/// The value if it is a legal `id`; else empty.
std::optional<Id> read_id(std::string_view text) {
  if (text.empty() || text.size() > kMostIdText) return std::nullopt;
  json value = json::parse(text, nullptr, false);
  if (value.is_discarded()) return std::nullopt;
  json object = json::object();
  object["id"] = std::move(value);
  std::optional<Id> id;
  FieldReader(object).read_id("id", id);
  return id;
}

/// Walks over the members of an object and inspects only where they begin and end.
class MemberScanner {
 public:
  explicit MemberScanner(std::string_view text) : text_(text) {}

  std::optional<Id> find_id() {
    skip_space();
    if (!take('{')) return std::nullopt;
    std::optional<Id> id;
    do {
      std::string_view key, value;
      skip_space();
      if (!take_string(key)) return std::nullopt;
      skip_space();
      if (!take(':')) return std::nullopt;
      skip_space();
      if (!take_value(value)) return std::nullopt;
      if (key != R"("id")") continue;
      if (id) return std::nullopt;
      id = read_id(value);
    } while (take(','));
    if (!take('}')) return std::nullopt;
    skip_space();
    return at_ == text_.size() ? id : std::nullopt;
  }

 private:
  void skip_space() { at_ = std::min(text_.find_first_not_of(kSpace, at_), text_.size()); }

  bool take(char wanted) {
    if (at_ == text_.size() || text_[at_] != wanted) return false;
    ++at_;
    return true;
  }

  bool take_string(std::string_view& string) {
    const std::size_t begin = at_;
    if (!take('"')) return false;
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\\') {
        ++at_;
      } else if (take('"')) {
        string = text_.substr(begin, at_ - begin);
        return true;
      }
    }
    return false;
  }

  /// Up to the comma or brace that follows.
  bool take_value(std::string_view& value) {
    const std::size_t begin = at_;
    for (std::size_t depth = 0; at_ < text_.size();) {
      const char c = text_[at_];
      if (depth == 0 && (c == ',' || c == '}')) {
        const std::string_view span = text_.substr(begin, at_ - begin);
        value = span.substr(0, span.find_last_not_of(kSpace) + 1);
        return true;
      }
      std::string_view string;
      if (c == '"') {
        if (!take_string(string)) return false;
        continue;
      }
      if (c == '{' || c == '[') ++depth;
      if ((c == '}' || c == ']') && depth-- == 0) return false;
      ++at_;
    }
    return false;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

std::optional<Id> find_id(std::string_view text) {
  return MemberScanner(text).find_id();
}

}  // namespace weft::proto
