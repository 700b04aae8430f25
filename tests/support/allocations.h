#pragma once

#include <cstddef>

namespace weft::test {

/// How often the program has taken memory from the heap with `new`. Only in programs that link
/// allocations.cpp.
std::size_t count_allocations();

}  // namespace weft::test
