#include "server/commands/start_file.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/world/constants.h"
#include "server/commands/npy.h"
#include "server/options.h"

namespace weft::server {
namespace {

constexpr const char* kAllowed =
    "a .npy file of a series, or of an array of particles x 3 or 6 numbers";

/// Columns of a field with one row for each particle; 0 if it is none.
std::size_t columns_of(const NpyField* field) {
  const bool rows = field && field->kind == 'f' && field->shape.size() == 2 &&
                    field->shape[0] <= kMostWorldParticles;
  return rows ? field->shape[1] : 0;
}

double number_at(const char* bytes, std::size_t size) {
  if (size == sizeof(double)) {
    double value = 0;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }
  float value = 0;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

/// Three columns of a field, from `first` on.
std::vector<Vec3d> vectors_of(const std::string& record, const NpyField& field, std::size_t first) {
  std::vector<Vec3d> vectors(field.shape[0]);
  for (std::size_t row = 0; row < vectors.size(); ++row) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t number = row * field.shape[1] + first + k;
      vectors[row][static_cast<int>(k)] =
          number_at(record.data() + field.offset + number * field.bytes, field.bytes);
    }
  }
  return vectors;
}

/// The bytes of a file from a place on.
std::string bytes_at(std::ifstream& file, std::size_t place, std::size_t count) {
  std::string bytes(count, '\0');
  file.clear();
  file.seekg(static_cast<std::streamoff>(place));
  file.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

/// Throws if anything follows a table, which would then not be what its writer meant.
void check_end(std::ifstream& file, const NpyTable& table) {
  file.clear();
  file.seekg(0, std::ios::end);
  const auto bytes = static_cast<std::size_t>(file.tellg());
  const std::size_t end = table.header_bytes + table.records * table.record_bytes;
  if (bytes > end)
    throw std::runtime_error("it has " + std::to_string(bytes - end) + " bytes behind its array");
}

StartDef start_of(std::ifstream& file) {
  const NpyTable table = read_npy_header(bytes_at(file, 0, kMostNpyHeader));
  const NpyField* array = table.field("");
  const NpyField *x = array ? array : table.field("x"), *v = array ? array : table.field("v");
  const std::size_t columns = columns_of(x);
  const bool array_fits = array && (columns == 3 || columns == 6);
  const bool series_fits = !array && columns == 3 && columns_of(v) == 3;
  if (!array_fits && !series_fits)
    throw std::runtime_error("it has no rows of 3 or 6 numbers, and no fields x and v of 3");
  if (table.records == 0) throw std::runtime_error("it has no record");
  const std::size_t last = table.header_bytes + (table.records - 1) * table.record_bytes;
  // What is not needed, such as forces, may be of any size.
  const std::size_t end =
      std::max(x->offset + x->count() * x->bytes, v->offset + v->count() * v->bytes);
  const std::string record = bytes_at(file, last, end);
  if (record.size() < end) throw std::runtime_error("it is cut off");
  check_end(file, table);
  StartDef start;
  start.x = vectors_of(record, *x, 0);
  if (!array || columns == 6) start.v = vectors_of(record, *v, array ? 3 : 0);
  return start;
}

}  // namespace

StartDef read_start(const std::string& path) {
  std::error_code error;
  std::ifstream file;
  if (std::filesystem::is_regular_file(path, error)) file.open(path, std::ios::binary);
  if (!file.is_open())
    throw OptionError("--start", path, std::string(kAllowed) + " that can be read");
  try {
    return start_of(file);
  } catch (const std::runtime_error& reason) {
    throw OptionError("--start", path, std::string(kAllowed) + "; " + reason.what());
  }
}

}  // namespace weft::server
