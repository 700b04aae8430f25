#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "proto/field.h"
#include "proto/types.h"
#include "tests/fuzz/dice.h"

// Draws the fields of a command from its description, so that a field that it gains is drawn too.

namespace weft::fuzz {

/// A walker of proto's descriptions (proto/field.h).
class FieldDraw {
 public:
  /// @param wild  probability that a number is not near a usual one
  FieldDraw(const Dice& dice, double wild) : dice_(dice), wild_(wild) {}

  template <class Value>
  void required(const proto::Field& field, Value& value) {
    draw(field, dice_.of(field.name), value);
  }
  template <class Value>
  void optional(const proto::Field& field, Value& value) {
    Dice dice = dice_.of(field.name);
    if (std::exchange(must_, false) || dice.chance(0.5)) draw(field, dice, value);
  }
  template <class Value>
  void only_if(bool condition, const char*, const proto::Field& field, Value& value, bool) {
    if (condition) optional(field, value);
  }
  void one_at_least(const char*) {}

 private:
  /// Near a value of everyday size: the middle decade of a positive range, or a thousandth.
  static double usual_of(const Range& range) {
    if (range.minimum < 0) return 0;
    return range.minimum > 0 ? std::sqrt(range.minimum * range.maximum) : range.maximum * 1e-3;
  }
  double number(const proto::Field& field, Dice& dice) const {
    return dice.number(field.range.minimum, field.range.maximum, usual_of(field.range), wild_);
  }

  template <class Value>
  void draw(const proto::Field& field, Dice dice, std::optional<Value>& value) {
    draw(field, dice, value.emplace());
  }
  void draw(const proto::Field& field, Dice dice, double& value) { value = number(field, dice); }
  void draw(const proto::Field& field, Dice dice, std::uint32_t& value) {
    value = static_cast<std::uint32_t>(number(field, dice));
  }
  void draw(const proto::Field&, Dice dice, bool& value) { value = dice.chance(0.5); }
  void draw(const proto::Field& field, Dice dice, proto::Vec3& value) {
    for (double& each : value) each = number(field, dice);
    if (field.form == proto::Form::direction && value == proto::Vec3{}) value[dice.below(3)] = 1;
  }
  /// A name of something that may be there, or not.
  void draw(const proto::Field&, Dice dice, std::string& value) {
    value = dice.chance(0.7) ? "silk" : "nothing";
  }
  void draw(const proto::Field&, Dice dice, proto::ColliderRef& value) {
    value = static_cast<std::uint32_t>(dice.below(3));
  }
  template <class Value>
  requires proto::Worded<Value>
  void draw(const proto::Field&, Dice dice, Value& value) {
    value = static_cast<Value>(dice.below(proto::kWords<Value>.size()));
  }
  template <class Value>
  requires proto::Described<Value>
  void draw(const proto::Field&, Dice dice, Value& value) {
    FieldDraw inner(dice, wild_);
    Value::describe(inner, value);
  }
  template <class Element>
  void draw(const proto::Field& field, Dice dice, std::vector<Element>& list) {
    list.resize(dice.below(static_cast<std::size_t>(field.range.maximum) + 1));
    for (std::size_t k = 0; k < list.size(); ++k) draw(field, dice.of(k), list[k]);
  }

  Dice dice_;
  double wild_;
  bool must_ = true;  ///< the first optional field is drawn, as one has to be there
};

}  // namespace weft::fuzz
