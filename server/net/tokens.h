#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/room/rights.h"

namespace weft::server {

/// The tokens that let viewers in, each with what it grants. Any thread may ask.
class Tokens {
 public:
  /// Adds those of a text: one a line, `role token [name]`; empty lines and those that begin with #
  /// count for nothing. Throws OptionError, which names the line and repeats no token.
  /// @param source  as the error names it, e.g. "--tokens"
  void read(const char* source, const std::string& text);

  /// Adds the tokens of a file, and tells in the log if others may read it. Throws OptionError.
  void read_file(const std::string& path);

  /// Makes a token that was never given before, and numbers it.
  std::string make(const Grant& grant);

  /// What a token grants in a room. Takes as long for a wrong token as for a right one.
  std::optional<Grant> find(std::string_view token, std::string_view room) const;

  /// Forgets those that count in a room: it has gone, and another may take its name.
  void forget(std::string_view room);

  /// Whether viewers need one: some were given at the start.
  bool required() const { return required_; }

 private:
  struct Entry {
    std::string token;
    Grant grant;
    bool made = false;  ///< by `make`
  };
  void add_line(const char* source, int number, std::string_view line);

  mutable std::mutex mutex_;
  std::vector<Entry> entries_;
  std::uint64_t last_number_ = 0;  // of a token
  bool required_ = false;          // set before other threads ask
};

/// Refuses a token, without repeating it.
/// @param entry    of a viewer that is not let in; otherwise one that is there
/// @param command  of its message; empty: none that is known
/// @param id       of its message
proto::Error unknown_token(bool entry, std::string command, const std::optional<proto::Id>& id);

}  // namespace weft::server
