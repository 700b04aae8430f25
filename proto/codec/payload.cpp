#include "proto/codec/payload.h"

#include <cassert>
#include <cmath>

namespace weft::proto::codec {
namespace {

struct Fields {
  std::uint8_t base, spatial;
  std::uint16_t zero;
  std::uint32_t before, raw_bytes, sum_a, sum_b;
};
static_assert(sizeof(Fields) == 20);

template <class T>
void put(Bytes& out, const T& value) {
  const std::size_t at = out.size();
  out.resize(at + sizeof value);
  std::memcpy(out.data() + at, &value, sizeof value);
}

bool in_range(const Integers& integers) {
  // One pass without branches: k + 2^20 - 1, as unsigned, is at most 2^21 - 2.
  std::uint32_t outside = 0;
  for (int c = 0; c < 3; ++c) {
    const std::int32_t* const plane = integers.plane(c);
    for (std::uint32_t i = 0; i < integers.count; ++i)
      outside |= static_cast<std::uint32_t>(static_cast<std::uint32_t>(plane[i]) +
                                                static_cast<std::uint32_t>(kMostSteps - 1) >
                                            2 * static_cast<std::uint32_t>(kMostSteps - 1));
  }
  return outside == 0;
}

}  // namespace

Bytes PayloadEncoder::encode(const CodingOrder& order, const Lattice& lattice, const Integers& now,
                             const PackRequest& request) {
  assert(now.count == order.size());
  const References& references = request.references;
  const Prediction prediction = request.prediction
                                    ? *request.prediction
                                    : choose_prediction(order.neighbours, now, references);
  const std::size_t stride = std::size_t{now.count} + 1;
  differences_.resize(stride);
  residuals_.resize(3 * stride);
  for (int c = 0; c < 3; ++c) {
    difference(prediction.base, now, references, c, differences_.data());
    residuals_of(prediction.spatial, order.neighbours, differences_.data(),
                 residuals_.data() + static_cast<std::size_t>(c) * stride);
  }
  const Sums sums = sums_of(now);
  const std::uint32_t before = prediction.base == Base::straight ? request.before : 0;
  Bytes out;
  put(out, Fields{static_cast<std::uint8_t>(prediction.base),
                  static_cast<std::uint8_t>(prediction.spatial), 0, before, 0, sums.a, sums.b});
  if (!references.last) put(out, lattice.origin);
  const std::uint32_t raw_bytes = entropy_.encode(residuals_, order.neighbours, out);
  std::memcpy(out.data() + offsetof(Fields, raw_bytes), &raw_bytes, sizeof raw_bytes);
  return out;
}

Result<PayloadHeader> read_payload_header(std::span<const std::byte> payload, bool key) {
  const std::size_t size = sizeof(Fields) + (key ? 3 * sizeof(double) : 0);
  if (payload.size() < size) return binary_error("the packed positions are cut off");
  const auto fields = read_at<Fields>(payload, 0);
  if (fields.base > 2 || fields.spatial > 3 || fields.zero != 0)
    return binary_error("the prediction is unknown");
  PayloadHeader header;
  header.prediction = {static_cast<Base>(fields.base), static_cast<Spatial>(fields.spatial)};
  if (key && header.prediction.base != Base::none)
    return binary_error("a key frame builds on no other");
  if (header.prediction.base != Base::straight && fields.before != 0)
    return binary_error("a frame is named that is not needed");
  header.before = fields.before;
  header.raw_bytes = fields.raw_bytes;
  header.sums = {fields.sum_a, fields.sum_b};
  if (key) header.origin = read_at<std::array<double, 3>>(payload, sizeof(Fields));
  for (const double x : header.origin)
    if (!std::isfinite(x)) return binary_error("the origin is not finite");
  header.coded = payload.subspan(size);
  return header;
}

std::optional<Error> PayloadDecoder::decode(const CodingOrder& order, const PayloadHeader& header,
                                            const References& references, Integers& out) {
  const std::size_t stride = std::size_t{order.size()} + 1;
  differences_.resize(stride);
  residuals_.resize(3 * stride);
  if (!entropy_.decode(header.coded, header.raw_bytes, order.neighbours, residuals_))
    return binary_error("the packed positions cannot be read");
  out.resize(order.size());
  for (int c = 0; c < 3; ++c)
    restore(header.prediction, order.neighbours, references, c,
            residuals_.data() + static_cast<std::size_t>(c) * stride, differences_.data(), out);
  if (!in_range(out)) return binary_error("a coordinate is out of range");
  if (sums_of(out) != header.sums) return binary_error("the sums of the coordinates do not match");
  return std::nullopt;
}

}  // namespace weft::proto::codec
