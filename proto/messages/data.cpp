#include "proto/messages/data.h"

#include <algorithm>
#include <cmath>

namespace weft::proto {
namespace {

struct DataFields {
  std::uint64_t tick;
  std::uint32_t transfer, count, components, zero;
};
constexpr std::size_t kDataBytes = kCommonBytes + sizeof(DataFields);
constexpr std::uint32_t kMostComponents = 16;
constexpr std::uint8_t kFloat32 = 0, kFloat64 = 1;

struct AckFields {
  BinaryType type;
  std::uint8_t version;
  std::uint16_t zero;
  std::uint32_t sequence;
};
static_assert(sizeof(AckFields) == kAckBytes);

template <class Real>
bool all_finite(const std::vector<Real>& values) {
  return std::all_of(values.begin(), values.end(), [](Real x) { return std::isfinite(x); });
}

template <class Real>
Bytes encode_values(std::uint8_t codec, const DataHeader& header, std::span<const Real> values) {
  Bytes out;
  BinaryWriter writer(out, BinaryType::data, codec, 0);
  const auto count = static_cast<std::uint32_t>(values.size() / header.components);
  writer.put(DataFields{header.tick, header.transfer, count, header.components, 0});
  writer.append(std::as_bytes(values));
  writer.finish();
  return out;
}

}  // namespace

Bytes encode_data(const DataHeader& header, std::span<const float> values) {
  return encode_values(kFloat32, header, values);
}

Bytes encode_data(const DataHeader& header, std::span<const double> values) {
  return encode_values(kFloat64, header, values);
}

Result<Data> decode_data(std::span<const std::byte> message) {
  const Result<BinaryHeader> common = read_header(message, BinaryType::data, kDataBytes, kFloat64);
  if (!common) return common.error();
  const auto fields = read_at<DataFields>(message, kCommonBytes);
  if (fields.tick >= kTickEnd || fields.zero != 0 || fields.components < 1 ||
      fields.components > kMostComponents)
    return binary_error("the header does not fit");
  const std::size_t value_bytes = common->codec == kFloat32 ? sizeof(float) : sizeof(double);
  // At most 2^32 * 16 * 8, far from overflow.
  const std::size_t bytes = std::size_t{fields.count} * fields.components * value_bytes;
  const std::span<const std::byte> rest = message.subspan(kDataBytes);
  if (rest.size() != padded(bytes)) return binary_error("the values do not fit");
  for (const std::byte b : rest.subspan(bytes))
    if (b != std::byte{0}) return binary_error("padding is not zero");
  Data data;
  data.header = {fields.tick, fields.transfer, fields.components};
  if (common->codec == kFloat32) {
    data.values = read_array<float>(rest.first(bytes));
  } else {
    data.values = read_array<double>(rest.first(bytes));
  }
  if (!std::visit([](const auto& values) { return all_finite(values); }, data.values))
    return binary_error("a value is not finite");
  return data;
}

std::size_t data_message_bytes(QueryFormat format, std::size_t count, std::size_t components) {
  const std::size_t value_bytes = format == QueryFormat::f64 ? sizeof(double) : sizeof(float);
  return padded(kDataBytes + count * components * value_bytes);
}

Bytes encode_ack(std::uint32_t sequence) {
  const AckFields fields{BinaryType::ack, kBinaryVersion, 0, sequence};
  const auto bytes = std::as_bytes(std::span(&fields, 1));
  return {bytes.begin(), bytes.end()};
}

Result<std::uint32_t> decode_ack(std::span<const std::byte> message) {
  if (message.size() != kAckBytes) return binary_error("an ack has 8 bytes");
  const auto fields = read_at<AckFields>(message, 0);
  if (fields.type != BinaryType::ack || fields.version != kBinaryVersion || fields.zero != 0)
    return binary_error("not an ack of version 1");
  return fields.sequence;
}

}  // namespace weft::proto
