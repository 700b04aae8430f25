#include "proto/messages/strict_json.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "proto/utf8.h"

namespace weft::proto {
namespace {

using nlohmann::json;

// Builds the tree from the parser's events. The library's own builder silently keeps the last of
// two equal keys and has no depth limit.
class StrictBuilder {
 public:
  StrictBuilder() : root_(nullptr) {}
  StrictBuilder(const StrictBuilder&) = delete;  // levels point into the tree
  StrictBuilder& operator=(const StrictBuilder&) = delete;

  bool null() { return put(nullptr) != nullptr; }
  bool boolean(bool value) { return put(value) != nullptr; }
  bool number_integer(std::int64_t value) { return put(value) != nullptr; }
  bool number_unsigned(std::uint64_t value) { return put(value) != nullptr; }
  bool number_float(double value, const std::string&) { return put(value) != nullptr; }
  bool string(std::string& value) { return put(std::move(value)) != nullptr; }
  bool binary(json::binary_t&) { return false; }  // never in JSON text

  bool start_object(std::size_t) { return open(json::object()); }
  bool start_array(std::size_t) { return open(json::array()); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }

  bool key(std::string& name) {
    Level& level = levels_.back();
    level.key = std::move(name);
    if (!level.container->contains(level.key)) return true;
    return fail(ErrorCode::duplicate_key, "the key " + path() + " appears twice in an object");
  }

  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::detail::exception& cause) {
    constexpr int kNumberOverflow = 406;
    if (cause.id == kNumberOverflow) {
      fail(ErrorCode::not_finite, path() + " is too large for a number");
      error_.value = quoted_value(token);
      return false;
    }
    return fail(ErrorCode::bad_json, "not JSON at byte " + std::to_string(position));
  }

  Result<json> finish(bool parsed) && {
    if (!parsed) return std::move(error_);
    if (!root_.is_object()) {
      return make_error(ErrorCode::not_an_object, "a message must be one JSON object",
                        R"(send for instance {"op": "pause"})");
    }
    return std::move(root_);
  }

 private:
  struct Level {
    json* container;
    std::string key;  // of the member being read, in objects
  };

  template <class Value>
  json* put(Value&& value) {
    if (levels_.empty()) {
      root_ = std::forward<Value>(value);
      return &root_;
    }
    Level& level = levels_.back();
    if (level.container->is_array()) {
      level.container->push_back(std::forward<Value>(value));
      return &level.container->back();
    }
    return &((*level.container)[level.key] = std::forward<Value>(value));
  }

  bool open(json container) {
    if (levels_.size() == kMostDepth) {
      const std::string levels = std::to_string(kMostDepth);
      return fail(ErrorCode::bad_json, "nested deeper than " + levels + " levels");
    }
    levels_.push_back({put(std::move(container)), {}});
    return true;
  }

  bool close() {
    levels_.pop_back();
    return true;
  }

  std::string path() const {
    std::string text;
    for (const Level& level : levels_) {
      if (level.container->is_array()) {
        // The array already contains an open element, but not a refused number.
        const std::size_t open = &level == &levels_.back() ? 0 : 1;
        const std::size_t index = level.container->size() - open;
        text.append("[").append(std::to_string(index)).append("]");
      } else {
        text.append(text.empty() ? "" : ".").append(level.key);
      }
    }
    constexpr std::size_t kMostPathCharacters = 200;  // keys come from the sender, and may be long
    return text.empty() ? "message" : std::string(first_characters(text, kMostPathCharacters));
  }

  bool fail(ErrorCode code, std::string message) {
    error_ = make_error(code, std::move(message));
    if (code != ErrorCode::bad_json) error_.field = path();
    return false;
  }

  json root_;
  std::vector<Level> levels_;
  Error error_;
};

}  // namespace

Result<json> parse_object(std::string_view text, std::size_t most_bytes) {
  if (text.size() > most_bytes) {
    Error error = make_error(ErrorCode::too_large, "the message has more than " +
                                                       std::to_string(most_bytes / 1024) + " KiB");
    error.value = std::to_string(text.size());
    error.limit = Limit{{}, static_cast<double>(most_bytes), {}, {}};
    return error;
  }
  if (!is_utf8(text)) return make_error(ErrorCode::bad_utf8, "the message is not UTF-8");
  // The parser takes a zero byte for the end of the text and would ignore the rest.
  if (text.find('\0') != std::string_view::npos)
    return make_error(ErrorCode::bad_json, "the message has a zero byte");
  StrictBuilder builder;
  const bool parsed = json::sax_parse(text.begin(), text.end(), &builder);
  return std::move(builder).finish(parsed);
}

}  // namespace weft::proto
