#include "tests/support/repeat.h"

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>

#define CATCH_CONFIG_EXTERNAL_INTERFACES
#include <catch2/catch.hpp>

namespace weft::test {
namespace {

namespace fs = std::filesystem;

std::optional<unsigned> wanted_seed() {
  const char* text = std::getenv("WEFT_SEED");
  if (text == nullptr) return std::nullopt;
  return static_cast<unsigned>(std::strtoul(text, nullptr, 10));
}

/// As it is told in the project's folder; whole if it is elsewhere.
std::string from_project(const fs::path& path) {
  const fs::path relative = fs::proximate(path, WEFT_SOURCE_DIR);
  return relative.is_absolute() || *relative.begin() == ".." ? path.string() : relative.string();
}

/// As one word of a shell.
std::string quoted(const std::string& text) {
  std::string word = "'";
  for (const char c : text) c == '\'' ? word += "'\\''" : word += c;
  return word + "'";
}

/// A name as Catch2's filter takes it: there, commas part names and brackets are tags.
std::string escaped(const std::string& name) {
  std::string filter;
  for (const char c : name) {
    if (c == ',' || c == '[' || c == ']' || c == '"' || c == '\\' || c == '~') filter += '\\';
    filter += c;
  }
  return filter;
}

/// Seeds of those who live, or did when the exception was thrown that is on its way.
std::vector<unsigned>& running_seeds() {
  static std::vector<unsigned> seeds;
  return seeds;
}

/// Prints how to repeat what failed.
struct RepeatPrinter : Catch::TestEventListenerBase {
  using TestEventListenerBase::TestEventListenerBase;

  void testCaseStarting(const Catch::TestCaseInfo& info) override {
    TestEventListenerBase::testCaseStarting(info);
    running_seeds().clear();
    printed_.clear();
  }
  bool assertionEnded(const Catch::AssertionStats& stats) override {
    if (stats.assertionResult.isOk() || running_seeds().empty()) return true;
    const std::string line = repeat_line(running_seeds().back());
    if (line != printed_) std::cout << "repeat with: " << line << std::endl;
    printed_ = line;
    return true;
  }

 private:
  std::string printed_;
};
CATCH_REGISTER_LISTENER(RepeatPrinter)

}  // namespace

unsigned seed_or(unsigned usual) {
  return wanted_seed().value_or(usual);
}

std::vector<unsigned> seeds(unsigned first, unsigned last) {
  if (const std::optional<unsigned> wanted = wanted_seed()) return {*wanted};
  std::vector<unsigned> all;
  for (unsigned seed = first; seed <= last; ++seed) all.push_back(seed);
  return all;
}

bool is_chosen(unsigned seed) {
  return seed_or(seed) == seed;
}

std::string repeat_line(unsigned seed) {
  std::string line;
  // Where the meshes of packages are; without it scenes with them are left out.
  if (const char* build = std::getenv("WEFT_BUILD_DIR"))
    line += "WEFT_BUILD_DIR=" + quoted(from_project(build)) + ' ';
  line += "WEFT_SEED=" + std::to_string(seed) + ' ';
  line += quoted(from_project(fs::read_symlink("/proc/self/exe"))) + ' ';
  return line + quoted(escaped(Catch::getResultCapture().getCurrentTestName()));
}

Repeatable::Repeatable(unsigned seed) : exceptions_(std::uncaught_exceptions()) {
  running_seeds().push_back(seed);
}

Repeatable::~Repeatable() {
  // Catch2 reports an exception after it has left the test case.
  if (std::uncaught_exceptions() == exceptions_) running_seeds().pop_back();
}

}  // namespace weft::test
