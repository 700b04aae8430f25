#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "proto/binary.h"

namespace weft::test {

/// The content of a golden file; fails the test if it cannot be read.
std::string read_golden(const std::string& name);
nlohmann::json read_golden_json(const std::string& name);
proto::Bytes read_golden_bytes(const std::string& name);

/// The ```json blocks of proto/README.md, in order.
std::vector<std::string> specification_examples();

proto::Bytes bytes_of_hex(const std::string& hex);

/// Length and checksum put right again after a change, so that a decoder looks further.
proto::Bytes sealed(proto::Bytes message);

}  // namespace weft::test
