#pragma once

#include <string>
#include <vector>

// Random properties that can be repeated: what fails prints one line that, typed in the project's
// folder, runs that test case with that seed alone.

namespace weft::test {

/// The seed that the environment's `WEFT_SEED` asks for, or the usual one.
unsigned seed_or(unsigned usual);

/// The seeds that a property is tried with: from the first to the last, or the one of `WEFT_SEED`
/// alone, whichever it is.
std::vector<unsigned> seeds(unsigned first, unsigned last);

/// Whether a seed is to be tried, where each one stands for a case of its own: all are, or the one
/// of `WEFT_SEED` alone.
bool is_chosen(unsigned seed);

/// The line that repeats the running test case with a seed: seed, program and the case's name, such
/// that a shell and Catch2 take it for what it is. The program is told from the project's folder
/// on; if it is not in there, from the root of the file system.
std::string repeat_line(unsigned seed);

/// While it lives, the first failure prints the line, whole and at once (Catch2 would wrap it).
class Repeatable {
 public:
  explicit Repeatable(unsigned seed);
  ~Repeatable();
  Repeatable(const Repeatable&) = delete;
  Repeatable& operator=(const Repeatable&) = delete;

 private:
  int exceptions_;
};

}  // namespace weft::test
