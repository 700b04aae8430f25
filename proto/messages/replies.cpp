#include "proto/messages/replies.h"

#include <array>
#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

#include "proto/messages/data.h"
#include "proto/messages/event_json.h"
#include "proto/messages/json_output.h"

namespace weft::proto {

using Json = nlohmann::ordered_json;

Json json_of(const ViewerCamera& camera) {
  Json out = {{"viewer", camera.viewer}};
  put_fields(out, camera.camera);
  return out;
}

Json json_of(const Measurements& measurements) {
  Json out = Json::object();
  for (const auto& [name, value] : measurements.values) out[name] = value;
  return out;
}

namespace {

struct DataName {
  QueryWhat operator()(const Energy&) const { return QueryWhat::energies; }
  QueryWhat operator()(const Strain&) const { return QueryWhat::strain; }
  QueryWhat operator()(const std::vector<PinInfo>&) const { return QueryWhat::pins; }
  QueryWhat operator()(const std::vector<GrabInfo>&) const { return QueryWhat::grabs; }
  QueryWhat operator()(const std::vector<ViewerCamera>&) const { return QueryWhat::camera; }
  QueryWhat operator()(const std::vector<ViewerInfo>&) const { return QueryWhat::roster; }
  QueryWhat operator()(const State&) const { return QueryWhat::state; }
  QueryWhat operator()(const std::vector<StageWork>&) const { return QueryWhat::work; }
  QueryWhat operator()(const std::vector<TreeInfo>&) const { return QueryWhat::trees; }
  QueryWhat operator()(const std::vector<ColliderPose>&) const { return QueryWhat::colliders; }
  QueryWhat operator()(const Measurements&) const { return QueryWhat::measurements; }
  QueryWhat operator()(const std::vector<ContactInfo>&) const { return QueryWhat::contacts; }
  QueryWhat operator()(const ReactionInfo&) const { return QueryWhat::reactions; }
  QueryWhat operator()(const std::vector<GripperInfo>&) const { return QueryWhat::grippers; }
  QueryWhat operator()(const Crossings&) const { return QueryWhat::crossings; }
  QueryWhat operator()(const EnergyBalance&) const { return QueryWhat::balance; }
};

struct ReplyWriter {
  Json& out;

  void start(const char* command, std::uint64_t tick) {
    out["command"] = command;
    out["tick"] = tick;
  }

  static const char* command_of(const DoneReply& reply) { return reply.command; }
  static const char* command_of(const PauseReply& reply) {
    return reply.paused ? "pause" : "resume";
  }
  static const char* command_of(const auto& reply) { return reply.kOp; }

  void operator()(const Described auto& reply) {
    out["command"] = command_of(reply);
    put_fields(out, reply);
  }
  void operator()(const VectorsReply& r) {  // the data is appended as text
    start("query", r.tick);
    out["what"] = name_of(r.what);
  }
  void operator()(const BinaryReply& r) {
    start("query", r.tick);
    out["what"] = name_of(r.what);
    out["format"] = name_of(r.format);
    out["binary"] = {{"transfer", r.transfer},
                     {"count", r.count},
                     {"components", r.components},
                     {"bytes", data_message_bytes(r.format, r.count, r.components)}};
  }
  void operator()(const QueryReply& r) {
    start("query", r.tick);
    out["what"] = name_of(std::visit(DataName{}, r.data));
    out["data"] = std::visit([](const auto& data) { return json_of(data); }, r.data);
  }
};

// Written by hand because a tree of a hundred thousand nodes costs megabytes, and because the text
// of a float is half as long when it is formatted as a float.
template <class Real>
void append_rows(std::span<const Real> values, std::size_t components, std::string& out) {
  std::array<char, 32> buffer;
  out += '[';
  for (std::size_t i = 0; i + components <= values.size(); i += components) {
    if (i > 0) out += ',';
    for (std::size_t k = 0; k < components; ++k) {
      out += k == 0 ? '[' : ',';
      if (!std::isfinite(values[i + k])) {
        out += "null";  // as the library does: JSON has no such number
        continue;
      }
      const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), values[i + k]);
      out.append(buffer.data(), end.ptr);
    }
    out += ']';
  }
  out += ']';
}

Json json_of_limit(const Limit& limit) {
  Json out = Json::object();
  put_if(out, "minimum", limit.minimum);
  put_if(out, "maximum", limit.maximum);
  put_if(out, "length", limit.length);
  if (!limit.allowed.empty()) out["allowed"] = limit.allowed;
  return out;
}

}  // namespace

std::string encode_reply(const Id& id, const Reply& reply) {
  Json out = {{"op", "result"}};
  put_id(out, id);
  std::visit(ReplyWriter{out}, reply);
  std::string text = text_of(out);
  if (const auto* vectors = std::get_if<VectorsReply>(&reply)) {
    text.back() = ',';
    text += "\"data\":";
    std::visit([&](auto values) { append_rows(values, vectors->components, text); },
               vectors->values);
    text += '}';
  }
  return text;
}

std::string encode_error(const Error& error) {
  Json out = {{"op", "error"}};
  if (error.id) put_id(out, *error.id);
  if (!error.command.empty()) out["command"] = error.command;
  out["code"] = name_of(error.code);
  out["message"] = error.message;
  if (!error.field.empty()) out["field"] = error.field;
  if (!error.value.empty()) {
    Json value = Json::parse(error.value, nullptr, false);
    if (!value.is_discarded()) out["value"] = std::move(value);
  }
  if (error.limit) out["limit"] = json_of_limit(*error.limit);
  if (!error.hint.empty()) out["hint"] = error.hint;
  return text_of(out);
}

}  // namespace weft::proto
