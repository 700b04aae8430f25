#include "server/commands/npy.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

namespace weft::server {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kMagic("\x93NUMPY\x01\x00", 8);
constexpr std::size_t kAlignment = 64;
constexpr std::size_t kMostNumbers = std::size_t{1} << 40;

/// a * b; throws if that is more than a file can hold.
std::size_t product(std::size_t a, std::size_t b) {
  if (b != 0 && a > kMostNumbers / b) throw std::runtime_error("it is too large");
  return a * b;
}

/// A Python literal of a header as JSON: these have the same strings without escapes.
std::string json_of_literal(std::string_view literal) {
  std::string json;
  for (std::size_t k = 0; k < literal.size(); ++k) {
    const char c = literal[k];
    if (literal.substr(k, 4) == "True" || literal.substr(k, 5) == "False") {
      json += c == 'T' ? "true" : "false";
      k += c == 'T' ? 3 : 4;
    } else if (c == '\'') {
      json += '"';
    } else if (c == '(' || c == '[') {
      json += '[';
    } else if (c == ')' || c == ']' || c == '}') {
      while (!json.empty() && (json.back() == ' ' || json.back() == ',')) json.pop_back();
      json += c == '}' ? '}' : ']';
    } else {
      json += c;
    }
  }
  return json;
}

std::vector<std::size_t> shape_of(const Json& node) {
  std::vector<std::size_t> shape;
  for (const Json& extent : node) {
    if (!extent.is_number_unsigned()) throw std::runtime_error("its shape is none");
    shape.push_back(extent.get<std::size_t>());
  }
  return shape;
}

/// @param type  such as "<f4"
NpyField field_of(std::string name, const std::string& type, std::vector<std::size_t> shape) {
  const bool known = type == "<f4" || type == "<f8" || type == "<u4" || type == "<u8";
  if (!known) throw std::runtime_error("it has numbers of type " + type);
  NpyField field;
  field.name = std::move(name);
  field.kind = type[1];
  field.bytes = type[2] == '4' ? 4 : 8;
  field.shape = std::move(shape);
  return field;
}

NpyTable table_of(const Json& header) {
  if (header.at("fortran_order").get<bool>()) throw std::runtime_error("it is in Fortran order");
  const Json& type = header.at("descr");
  std::vector<std::size_t> shape = shape_of(header.at("shape"));
  if (type.is_string())
    return npy_table({field_of("", type.get<std::string>(), std::move(shape))}, 1);
  std::vector<NpyField> fields;
  for (const Json& entry : type) {
    fields.push_back(
        field_of(entry.at(0).get<std::string>(), entry.at(1).get<std::string>(),
                 entry.size() > 2 ? shape_of(entry.at(2)) : std::vector<std::size_t>()));
  }
  if (shape.size() != 1) throw std::runtime_error("its records are no list");
  return npy_table(std::move(fields), shape[0]);
}

std::string shape_text(const std::vector<std::size_t>& shape) {
  std::string text = "(";
  for (const std::size_t extent : shape) text += std::to_string(extent) + ",";
  return text + ")";
}

}  // namespace

std::size_t NpyField::count() const {
  std::size_t count = 1;
  for (const std::size_t extent : shape) count = product(count, extent);
  return count;
}

const NpyField* NpyTable::field(std::string_view name) const {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [&](const NpyField& each) { return each.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

NpyTable npy_table(std::vector<NpyField> fields, std::size_t records) {
  NpyTable table;
  table.fields = std::move(fields);
  table.records = records;
  for (NpyField& field : table.fields) {
    field.offset = table.record_bytes;
    table.record_bytes += product(field.count(), field.bytes);
  }
  product(table.record_bytes, records);
  table.header_bytes = npy_header(table).size();
  return table;
}

std::string npy_header(const NpyTable& table) {
  std::string text = "{'descr': [";
  for (const NpyField& field : table.fields) {
    text += "('" + field.name + "', '<" + field.kind + std::to_string(field.bytes) + "'";
    if (!field.shape.empty()) text += ", " + shape_text(field.shape);
    text += "), ";
  }
  text += "], 'fortran_order': False, 'shape': (" + std::to_string(table.records) + ",), }";
  constexpr std::size_t kLengthBytes = 2;
  while ((kMagic.size() + kLengthBytes + text.size() + 1) % kAlignment != 0) text += ' ';
  text += '\n';
  std::string header(kMagic);
  header += static_cast<char>(text.size() & 0xff);
  header += static_cast<char>(text.size() >> 8);
  return header + text;
}

NpyTable read_npy_header(std::string_view bytes) {
  const std::size_t begin = kMagic.size() + 2;
  if (bytes.size() < begin || bytes.substr(0, kMagic.size()) != kMagic)
    throw std::runtime_error("it does not begin as such a file of version 1.0");
  const auto byte = [&](std::size_t k) {
    return static_cast<std::size_t>(static_cast<unsigned char>(bytes[k]));
  };
  const std::size_t size = byte(kMagic.size()) | byte(kMagic.size() + 1) << 8;
  if (bytes.size() < begin + size) throw std::runtime_error("its header is cut off");
  NpyTable table;
  try {
    table = table_of(Json::parse(json_of_literal(bytes.substr(begin, size))));
  } catch (const Json::exception&) {
    throw std::runtime_error("its header tells no type, shape and order");
  }
  table.header_bytes = begin + size;
  return table;
}

}  // namespace weft::server
