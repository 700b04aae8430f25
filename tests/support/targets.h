#pragma once

#include <cstdint>

#include <catch2/catch.hpp>
#include <hwy/targets.h>

namespace weft::test {

/// Lets the program use these instruction sets alone; 0 for all that there are.
inline void use_targets(std::int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

/// Calls `check` with each instruction set of this processor alone, of which there must be several,
/// and allows all of them again.
template <class Check>
void for_each_target(Check&& check) {
  use_targets(0);
  int tried = 0;
  for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
    use_targets(left & -left);
    INFO(hwy::TargetName(left & -left));
    check();
    ++tried;
  }
  use_targets(0);
  CHECK(tried > 1);
}

}  // namespace weft::test
