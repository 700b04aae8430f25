#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "proto/field.h"
#include "proto/frames/frame.h"

// What a frame consists of, as JSON, for the generator of the clients' decoders, declarations and
// tables (proto/generate.py).

namespace weft::proto {

/// The walker that tells the entries of a list: types as on the wire, one after the other.
class SampleDocument {
 public:
  using Json = nlohmann::ordered_json;

  /// @param fields  an array that each field is added to
  explicit SampleDocument(Json& fields) : fields_(fields) {}

  void required(const Field& field, float) { add(field, "f32", 4); }
  void required(const Field& field, std::uint32_t) { add(field, "u32", 4); }
  template <std::size_t N>
  void required(const Field& field, const std::array<float, N>&) {
    add(field, "f32x" + std::to_string(N), sizeof(float) * N);
  }
  template <Worded Enum>
  void required(const Field& field, Enum) {
    add(field, "word", sizeof(Enum))["words"] = kWords<Enum>;
  }
  void truth(const Field& field, std::uint32_t) { add(field, "truth", 4); }
  void collider_or_none(const Field& field, std::uint32_t) {
    add(field, "collider_or_none", 4)["none"] = kNoCollider;
  }

  /// Of what was told so far.
  std::size_t bytes() const { return bytes_; }

 private:
  Json& add(const Field& field, std::string type, std::size_t size) {
    Json& entry = fields_.emplace_back(Json{{"name", field.name}, {"meaning", field.meaning}});
    entry["type"] = std::move(type);
    entry["offset"] = bytes_;
    if (*field.unit != '\0') entry["unit"] = field.unit;
    bytes_ += size;
    return entry;
  }

  Json& fields_;
  std::size_t bytes_ = 0;
};

inline nlohmann::ordered_json part_document(const FramePart& part) {
  nlohmann::ordered_json out = {{"kind", part.kind}, {"name", part.name}, {"note", part.note}};
  if (part.keyed) out["keyed"] = true;
  if (*part.unit != '\0') out["unit"] = part.unit;
  return out;
}

template <Described Sample>
nlohmann::ordered_json sample_document() {
  nlohmann::ordered_json fields = nlohmann::ordered_json::array();
  SampleDocument document(fields);
  const Sample sample{};
  Sample::describe(document, sample);
  if (document.bytes() != sizeof(Sample))
    throw std::logic_error(std::string(Sample::kName) + ": not all fields are described");
  return {{"name", Sample::kName},
          {"each", Sample::kEach},
          {"bytes", document.bytes()},
          {"fields", std::move(fields)}};
}

inline nlohmann::ordered_json frame_document() {
  using Json = nlohmann::ordered_json;
  Json out = {{"flags", Json::array()}, {"lists", Json::array()}, {"arrays", Json::array()}};
  for (const FlagText& flag : kFrameFlags)
    out["flags"].push_back({{"bit", std::countr_zero(std::uint8_t{flag.flag})},
                            {"name", flag.name},
                            {"meaning", flag.meaning}});
  out["positions"] = {part_document(kPositionsPart), part_document(kPackedPositionsPart)};
  const Frame frame;
  visit_lists(frame, [&]<class Sample>(const FramePart& part, const std::vector<Sample>&) {
    Json list = part_document(part);
    list["sample"] = sample_document<Sample>();
    out["lists"].push_back(std::move(list));
  });
  visit_arrays(frame, [&](const FramePart& part, const std::vector<float>&) {
    out["arrays"].push_back(part_document(part));
  });
  return out;
}

}  // namespace weft::proto
