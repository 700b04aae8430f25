#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

// The header of NumPy's .npy files, version 1.0 (NEP 1): arrays of numbers, and of records with
// named fields. Bytes are little-endian, as on every machine that Weft runs on.

namespace weft::server {

/// A field of a record, or all of an array without fields (name empty).
struct NpyField {
  std::string name;
  char kind = 'f';                 ///< 'f' floating point, 'u' unsigned
  std::size_t bytes = 8;           ///< of a number: 4 or 8
  std::vector<std::size_t> shape;  ///< empty: one number
  std::size_t offset = 0;          ///< in the record [B]

  std::size_t count() const;  ///< of numbers
};

/// What a file holds, behind its header.
struct NpyTable {
  std::vector<NpyField> fields;
  std::size_t records = 0;
  std::size_t record_bytes = 0;
  std::size_t header_bytes = 0;

  /// Null if there is no such field.
  const NpyField* field(std::string_view name) const;
};

/// Bytes that a reader has to have to see any header that Weft accepts.
inline constexpr std::size_t kMostNpyHeader = 10 + 65'535;

/// A table of records, one field after the other.
NpyTable npy_table(std::vector<NpyField> fields, std::size_t records);

/// The header of a table, padded to a multiple of 64 bytes.
std::string npy_header(const NpyTable& table);

/// Reads a header. An array without fields becomes one record with one field without a name.
/// @param bytes  the beginning of a file, kMostNpyHeader of it or all
/// Throws std::runtime_error with the reason if it is none, or none of little-endian floats or
/// unsigned numbers in C order, or larger than a size can tell.
NpyTable read_npy_header(std::string_view bytes);

}  // namespace weft::server
