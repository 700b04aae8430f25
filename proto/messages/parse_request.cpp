// A text message as a command: which form of which command it is. What is in each form, its own
// description in messages/ says.

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "proto/messages/command_reader.h"
#include "proto/messages/commands.h"
#include "proto/messages/field_reader.h"
#include "proto/messages/strict_json.h"

namespace weft::proto {
namespace {

using nlohmann::json;

template <class Form>
Command read_as(FieldReader& in) {
  Form form;
  CommandReader reader(in);
  Form::describe(reader, form);
  return form;
}

/// Reads the command whose first form in `Command` is this one.
template <class First>
Command read_form(FieldReader& in) {
  return read_as<First>(in);
}

template <>
Command read_form<DragStart>(FieldReader& in) {
  DragPhase phase{};
  in.read("phase", phase, kWords<DragPhase>);
  if (phase == DragPhase::end) return read_as<DragEnd>(in);
  if (phase == DragPhase::move) return read_as<DragMove>(in);
  return read_as<DragStart>(in);
}

template <>
Command read_form<ReleasePin>(FieldReader& in) {
  const int given = int{in.has("pin")} + int{in.has("particle")} + int{in.has("all")};
  if (given != 1) {
    in.fail(given == 0 ? ErrorCode::missing_field : ErrorCode::conflicting_fields, "pin",
            "release needs one of pin, particle, all");
  }
  if (in.has("all")) return read_as<ReleaseAll>(in);
  if (in.has("particle")) return read_as<ReleaseParticle>(in);
  return read_as<ReleasePin>(in);
}

template <>
Command read_form<Move>(FieldReader& in) {
  if (in.has("pin")) return in.is_true("stop") ? read_as<StopPin>(in) : read_as<MovePin>(in);
  return in.is_true("release") ? read_as<MoveEnd>(in) : read_as<Move>(in);
}

struct Operation {
  std::string_view name;
  Command (*read)(FieldReader&);
};

template <class... Forms>
std::vector<Operation> operations_of(const std::variant<Forms...>&) {
  std::vector<Operation> list;
  const auto add = [&list](Operation operation) {
    const bool another_form = !list.empty() && list.back().name == operation.name;
    if (!another_form && operation.name != Halt::kOp) list.push_back(operation);
  };
  (add({Forms::kOp, read_form<Forms>}), ...);
  return list;
}

/// What a client may send.
const std::vector<Operation>& operations() {
  static const std::vector<Operation> kList = operations_of(Command{});
  return kList;
}

const Operation* find_operation(const std::string& name) {
  const auto it = std::find_if(operations().begin(), operations().end(),
                               [&name](const Operation& o) { return name == o.name; });
  return it == operations().end() ? nullptr : &*it;
}

Error unknown_operation(const std::string& name) {
  std::vector<std::string> names;
  for (const Operation& operation : operations()) names.emplace_back(operation.name);
  Error error = word_error("op", name, std::move(names));
  error.code = ErrorCode::unknown_op;
  return error;
}

}  // namespace

Result<Request> parse_request(std::string_view text) {
  Result<json> object = parse_object(text);
  if (!object) {
    Error error = std::move(object).error();
    error.id = find_id(text);
    return error;
  }
  FieldReader in(*object);
  Request request;
  std::string name;
  in.read_id("id", request.id);
  in.read("op", name);
  const Operation* operation = in.ok() ? find_operation(name) : nullptr;
  if (operation != nullptr) {
    request.command = operation->read(in);
  } else {
    in.fail(unknown_operation(name));
  }
  if (in.ok()) return request;
  Error error = *in.error();
  error.id = request.id;
  if (operation != nullptr) error.command = operation->name;
  return error;
}

std::optional<std::string> find_token(std::string_view text) {
  const Result<json> object = parse_object(text);
  if (!object || !object->contains("token") || object->value("op", json()) != Hello::kOp)
    return std::nullopt;
  const json bare = {{"token", object->at("token")}};
  FieldReader in(bare);
  const Command hello = read_as<Hello>(in);
  return in.ok() ? std::get<Hello>(hello).token : std::nullopt;
}

}  // namespace weft::proto
