#pragma once

#include <string>
#include <vector>

namespace weft::bench {

/// What is wanted of a figure.
enum class Bar { none, at_most, at_least };

/// A figure of a whole case with contact.
struct CaseFigure {
  std::string scene, name, unit;
  double value = 0;
  Bar kind = Bar::none;
  double bar = 0;  ///< in the unit of the value
  int runs = 1;    ///< whose median it is; 1 where every run has the same
};

/// 64 x 64 cotton: dropped and crumpled, at rest, touched, pulled through by a hand, on a
/// dressmaker's form, and hanging flat.
/// @param quick  24 x 24, once and shorter
std::vector<CaseFigure> measure_contact_cases(bool quick);

}  // namespace weft::bench
