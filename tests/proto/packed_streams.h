#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "proto/binary.h"
#include "proto/codec/order.h"

namespace weft::test {

/// A golden stream: what a server sends of a mesh and its frames.
struct PackedStream {
  std::string name;
  proto::Bytes mesh;
  proto::codec::CodingOrder order;
  std::vector<std::pair<proto::Bytes, proto::Bytes>> frames;  ///< each packed, and in float32
};

PackedStream packed_stream(const std::string& name);
void for_each_packed_stream(const std::function<void(const PackedStream&)>& visit);

}  // namespace weft::test
