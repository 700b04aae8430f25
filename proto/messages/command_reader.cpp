// What each form of value must keep to, and rules between fields.

#include "proto/messages/command_reader.h"

#include <algorithm>
#include <cmath>

#include "proto/room_name.h"
#include "proto/utf8.h"

namespace weft::proto {
namespace {

bool is_letter_or_digit(char x) {
  return (x >= '0' && x <= '9') || (x >= 'a' && x <= 'z') || (x >= 'A' && x <= 'Z');
}

bool is_color(const std::string& text) {
  const auto is_hex = [](char x) {
    return (x >= '0' && x <= '9') || (x >= 'a' && x <= 'f') || (x >= 'A' && x <= 'F');
  };
  return text.size() == 7 && text[0] == '#' && std::all_of(text.begin() + 1, text.end(), is_hex);
}

/// No path: neither a folder nor a hidden file.
bool is_plain_name(const std::string& text) {
  return !text.starts_with('.') && std::all_of(text.begin(), text.end(), [](char x) {
    return is_letter_or_digit(x) || x == '.' || x == '_' || x == '-';
  });
}

std::string length_message(const Field& field) {
  const std::string most = number_text(field.range.maximum) + " " + field.unit;
  if (field.range.minimum == 0) return std::string(field.name) + " must have at most " + most;
  return std::string(field.name) + " must have " + number_text(field.range.minimum) + " to " + most;
}

void check_length(FieldReader& in, const Field& field, const std::string& text) {
  const auto length =
      static_cast<double>(field.form == Form::characters ? character_count(text) : text.size());
  if (length >= field.range.minimum && length <= field.range.maximum) return;
  const Limit allowed{field.range.minimum, field.range.maximum, {}, {}};
  if (field.form != Form::secret) return in.fail_length(field.name, allowed, length_message(field));
  Error error = make_error(ErrorCode::wrong_length, length_message(field));
  error.field = field.name;  // its value is not repeated
  error.limit = allowed;
  in.fail(std::move(error));
}

}  // namespace

void CommandReader::read(const Field& field, Vec3& value) {
  in_.read(field.name, value, field.range);
  if (!in_.ok()) return;
  const std::string name = field.name;
  if (field.form == Form::direction &&
      std::max({std::abs(value[0]), std::abs(value[1]), std::abs(value[2])}) < kLeastDirection)
    in_.fail(ErrorCode::out_of_range, field.name, name + " must not be zero");
  if (field.form == Form::weights &&
      !(std::abs(value[0] + value[1] + value[2] - 1) <= kWeightSumTolerance))
    in_.fail(ErrorCode::out_of_range, field.name, name + " must have the sum 1");
}

void CommandReader::read(const Field& field, Quat& value) {
  in_.read(field.name, value, field.range);
  if (!in_.ok()) return;
  double norm2 = 0;
  for (const double q : value) norm2 += q * q;
  if (!(std::abs(std::sqrt(norm2) - 1) <= kUnitTolerance))
    in_.fail(ErrorCode::out_of_range, field.name, std::string(field.name) + " must have the norm 1",
             "a unit quaternion [x, y, z, w]");
}

void CommandReader::read(const Field& field, std::string& value) {
  in_.read(field.name, value);
  if (!in_.ok() || field.form == Form::plain) return;
  const std::string name = field.name;
  if (field.form == Form::color && !is_color(value))
    return in_.fail(ErrorCode::unknown_value, field.name,
                    name + " must be # and 6 hexadecimal digits", "for instance #e4572e");
  if (field.form == Form::color) return;
  check_length(in_, field, value);
  if (field.form == Form::characters && has_control_character(value))
    in_.fail(ErrorCode::unknown_value, field.name, name + " must not have control characters");
  if (field.form == Form::file_name && !is_plain_name(value))
    in_.fail(ErrorCode::unknown_value, field.name, name + " must be a plain name, not a path");
  if (field.form == Form::room_name && !is_room_name(value))
    in_.fail(ErrorCode::unknown_value, field.name,
             name + " must have lower-case letters, digits and hyphens alone, the first no hyphen",
             "for instance room-7");
}

void CommandReader::constant(const char* name, bool what) {
  bool told = what;
  in_.read_if_there(name, told);
  if (in_.ok() && told != what)
    in_.fail(ErrorCode::unknown_value, name,
             std::string(name) + (what ? " must be true" : " must be false"));
}

void CommandReader::hold(Hold& value) {
  if (in_.has("particle") && in_.has("triangle"))
    in_.fail(ErrorCode::conflicting_fields, "triangle", "triangle and particle exclude each other",
             "give triangle with barycentric, or particle");
  if (in_.has("triangle")) {
    SurfacePoint& point = value.emplace<SurfacePoint>();
    required(kHeldTriangle, point.triangle);
    required(kHeldWeights, point.barycentric);
  } else {
    required(kHeldParticle, value.emplace<Particle>().index);
  }
}

void CommandReader::scene(const Field& field, std::string& name, std::string& text) {
  if (!in_.read_object_text(field.name, text)) read(field, name);
}

void CommandReader::excludes(const char* name, std::initializer_list<const char*> others) {
  if (!in_.has(name)) return;
  for (const char* other : others) {
    if (in_.ok() && in_.has(other))
      in_.fail(ErrorCode::conflicting_fields, other,
               std::string(other) + " cannot be combined with " + name);
  }
}

void CommandReader::one_at_least(const char* message) {
  if (!in_.ok() || given_) return;
  Error error = make_error(ErrorCode::missing_field, message);
  error.limit = Limit{{}, {}, {}, offered_};
  in_.fail(std::move(error));
}

void CommandReader::rule(bool holds, ErrorCode code, const char* field, const char* message) {
  if (in_.ok() && !holds) in_.fail(code, field, message);
}

}  // namespace weft::proto
