#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proto/field.h"
#include "proto/messages/field_reader.h"
#include "proto/messages/hold_commands.h"

// The walker that fills a command from the fields of a JSON object. The first thing that is wrong
// stays as the error of its FieldReader, and nothing is read after it.

namespace weft::proto {

class CommandReader {
 public:
  explicit CommandReader(FieldReader& in) : in_(in) {}

  template <class Value>
  void required(const Field& field, Value& value) {
    read(field, value);
  }
  template <class Value>
  void optional(const Field& field, Value& value) {
    offered_.emplace_back(field.name);
    if (!in_.has(field.name)) return;
    given_ = true;
    read(field, value);
  }
  void flag(const Field& field, bool& value, bool) { optional(field, value); }

  template <class Value>
  void only_if(bool condition, const char* of, const Field& field, std::optional<Value>& value,
               bool required) {
    if (condition && (required || in_.has(field.name))) return read(field, value);
    if (!condition && in_.has(field.name))
      in_.fail(ErrorCode::conflicting_fields, field.name,
               std::string(field.name) + " is only for " + of);
  }

  void constant(const char*, const char*) {}  // read when the form was chosen
  void constant(const char* name, bool what);
  void usual(double& value, double number) { value = number; }
  void hold(Hold& value);
  void scene(const Field& field, std::string& name, std::string& text);
  /// Fields that mean nothing beside another are refused, not ignored, because their sender expects
  /// an effect.
  void excludes(const char* name, std::initializer_list<const char*> others);
  void one_at_least(const char* message);
  void rule(bool holds, ErrorCode code, const char* field, const char* message);

 private:
  template <class Value>
  void read(const Field& field, std::optional<Value>& value) {
    Value present{};
    read(field, present);
    if (in_.ok()) value = std::move(present);
  }
  template <class Element>
  void read(const Field& field, std::vector<Element>& list) {
    in_.read_objects(field.name, static_cast<std::size_t>(field.range.maximum),
                     [&list](FieldReader& in) {
                       CommandReader inner(in);
                       Element::describe(inner, list.emplace_back());
                     });
  }
  template <Worded Enum>
  void read(const Field& field, std::vector<Enum>& list) {
    in_.read_words(field.name, static_cast<std::size_t>(field.range.maximum), kWords<Enum>,
                   [&list](std::size_t place) { list.push_back(static_cast<Enum>(place)); });
  }
  template <Described Value>
  void read(const Field& field, Value& value) {
    in_.read_object(field.name, [&value](FieldReader& in) {
      CommandReader inner(in);
      Value::describe(inner, value);
    });
  }
  template <Worded Enum>
  void read(const Field& field, Enum& value) {
    in_.read(field.name, value, kWords<Enum>);
  }
  void read(const Field& field, bool& value) { in_.read(field.name, value); }
  void read(const Field& field, double& value) { in_.read(field.name, value, field.range); }
  void read(const Field& field, std::uint32_t& value) { in_.read(field.name, value, field.range); }
  void read(const Field& field, ColliderRef& value) { in_.read(field.name, value); }
  void read(const Field& field, Vec3& value);
  void read(const Field& field, Quat& value);
  void read(const Field& field, std::string& value);

  FieldReader& in_;
  std::vector<std::string> offered_;  ///< optional fields so far
  bool given_ = false;                ///< whether one of them is there
};

}  // namespace weft::proto
