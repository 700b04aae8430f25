// Tokens from a file, the environment or an operator, and how they are compared.

#include "server/net/tokens.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <random>
#include <sstream>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <spdlog/spdlog.h>

#include "proto/hash_text.h"
#include "proto/limits.h"
#include "proto/utf8.h"
#include "server/descriptor.h"
#include "server/options.h"

namespace weft::server {
namespace {

constexpr std::size_t kMostFileBytes = std::size_t{64} << 10U;
constexpr std::size_t kLeastTokenBytes = 16;   // so that none can be guessed
constexpr std::size_t kMostMadeTokens = 4096;  // the oldest made token then counts no more
constexpr int kMadeWords = 2;                  // of 64 random bits, in a made token

/// Those that a link's fragment carries as they are.
bool is_token_character(char x) {
  return (x >= '0' && x <= '9') || (x >= 'a' && x <= 'z') || (x >= 'A' && x <= 'Z') || x == '-' ||
         x == '_' || x == '.' || x == '~';
}

/// The time depends on the length of what was asked alone.
bool equal(const std::string& token, std::string_view asked) {
  std::size_t difference = token.size() ^ asked.size();
  for (std::size_t i = 0; i < asked.size(); ++i)
    difference |= static_cast<std::size_t>(static_cast<unsigned char>(token[i % token.size()]) ^
                                           static_cast<unsigned char>(asked[i]));
  return difference == 0;
}

[[noreturn]] void refuse(const char* source, int number, const std::string& allowed) {
  throw OptionError(source, "line " + std::to_string(number), allowed);
}

std::optional<proto::Role> role_of(std::string_view word) {
  const auto& words = proto::kWords<proto::Role>;
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) return std::nullopt;
  return static_cast<proto::Role>(found - words.begin());
}

}  // namespace

void Tokens::add_line(const char* source, int number, std::string_view line) {
  std::istringstream words{std::string(line)};
  std::string role_word, token, name;
  words >> role_word >> token;
  if (role_word.empty() || role_word.front() == '#') return;
  std::getline(words, name);
  boost::algorithm::trim_if(name, boost::algorithm::is_any_of(" \t\r"));
  const auto role = role_of(role_word);
  if (!role) refuse(source, number, "viewer, operator or admin, a token, and perhaps a name");
  if (token.size() < kLeastTokenBytes || token.size() > proto::kMostTokenBytes ||
      !std::all_of(token.begin(), token.end(), is_token_character))
    refuse(source, number,
           "a token of " + std::to_string(kLeastTokenBytes) + " to " +
               std::to_string(proto::kMostTokenBytes) + " letters, digits, - _ . ~");
  if (!proto::is_utf8(name) || proto::has_control_character(name) ||
      proto::character_count(name) > proto::kMostNameCharacters)
    refuse(source, number,
           "a name of at most " + std::to_string(proto::kMostNameCharacters) + " characters");
  if (find(token, {})) refuse(source, number, "each token once");
  const std::lock_guard lock(mutex_);
  Grant grant{*role, HandRight::by_policy, name, true};
  grant.token = ++last_number_;
  // A token with a name is one person's; one without may be a whole class's.
  if (!name.empty()) grant.maker = "token " + std::to_string(grant.token);
  entries_.push_back({token, std::move(grant), false});
  required_ = true;
}

void Tokens::read(const char* source, const std::string& text) {
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) add_line(source, ++number, line);
  if (!required_) throw OptionError(source, "", "one line for each token: role token [name]");
  const bool operated = std::any_of(entries_.begin(), entries_.end(), [](const Entry& entry) {
    return entry.grant.role != proto::Role::viewer;
  });
  if (!operated) spdlog::warn("{} has no token of an operator", source);
}

void Tokens::read_file(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (file.number < 0 || ::fstat(file.number, &status) != 0)
    throw OptionError("--tokens", path, std::string("a file (") + std::strerror(errno) + ")");
  if (!S_ISREG(status.st_mode)) throw OptionError("--tokens", path, "a plain file");
  if (static_cast<std::size_t>(status.st_size) > kMostFileBytes)
    throw OptionError("--tokens", path,
                      "a file of at most " + std::to_string(kMostFileBytes) + " bytes");
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    spdlog::warn("others than its owner may open the file of tokens {}; chmod 600 mends that",
                 path);
  std::string text(kMostFileBytes, '\0');
  const ::ssize_t bytes = ::read(file.number, text.data(), text.size());
  if (bytes < 0) throw OptionError("--tokens", path, "a file that can be read");
  text.resize(static_cast<std::size_t>(bytes));
  read("--tokens", text);
}

std::string Tokens::make(const Grant& grant) {
  std::random_device source;
  std::string token;
  for (int k = 0; k < kMadeWords; ++k)
    token += proto::hash_text((static_cast<std::uint64_t>(source()) << 32U) | source());
  const std::lock_guard lock(mutex_);
  const auto made = [](const Entry& entry) { return entry.made; };
  if (std::count_if(entries_.begin(), entries_.end(), made) >=
      static_cast<std::ptrdiff_t>(kMostMadeTokens))
    entries_.erase(std::find_if(entries_.begin(), entries_.end(), made));
  entries_.push_back({token, grant, true});
  entries_.back().grant.token = ++last_number_;
  return token;
}

std::optional<Grant> Tokens::find(std::string_view token, std::string_view room) const {
  const std::lock_guard lock(mutex_);
  std::optional<Grant> found;
  for (const Entry& entry : entries_)
    if (equal(entry.token, token)) found = grant_in(entry.grant, room);
  return found;
}

void Tokens::forget(std::string_view room) {
  const std::lock_guard lock(mutex_);
  std::erase_if(entries_, [room](const Entry& entry) { return entry.grant.room == room; });
}

proto::Error unknown_token(bool entry, std::string command, const std::optional<proto::Id>& id) {
  proto::Error error = proto::make_error(
      proto::ErrorCode::not_allowed,
      entry ? "the first message has to be hello with a token that this server knows"
            : "this server does not know the token",
      "open the whole link that you were given, with what follows #token=");
  error.field = "token";
  error.command = std::move(command);
  error.id = id;
  return error;
}

}  // namespace weft::server
