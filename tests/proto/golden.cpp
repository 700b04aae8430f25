#include "tests/proto/golden.h"

#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace weft::test {
namespace {

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path);
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

}  // namespace

std::string read_golden(const std::string& name) {
  return read_file(std::string(WEFT_SOURCE_DIR) + "/tests/proto/golden/" + name);
}

nlohmann::json read_golden_json(const std::string& name) {
  return nlohmann::json::parse(read_golden(name));
}

proto::Bytes read_golden_bytes(const std::string& name) {
  const std::string content = read_golden(name);
  const auto* first = reinterpret_cast<const std::byte*>(content.data());
  return {first, first + content.size()};
}

std::vector<std::string> specification_examples() {
  std::istringstream page(read_file(std::string(WEFT_SOURCE_DIR) + "/proto/README.md"));
  std::vector<std::string> examples;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line == "```json") {
      examples.emplace_back();
      inside = true;
    } else if (line == "```") {
      inside = false;
    } else if (inside) {
      examples.back() += line + "\n";
    }
  }
  return examples;
}

proto::Bytes bytes_of_hex(const std::string& hex) {
  proto::Bytes bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes.push_back(static_cast<std::byte>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  return bytes;
}

proto::Bytes sealed(proto::Bytes message) {
  if (message.size() < proto::kCommonBytes) return message;
  const auto length = static_cast<std::uint32_t>(message.size());
  std::uint32_t sums[2] = {0, 0};
  std::memcpy(message.data() + 4, &length, 4);
  std::memcpy(message.data() + 8, sums, 8);
  for (std::uint32_t j = 0; j < length / 4; ++j) {
    const auto word = proto::read_at<std::uint32_t>(message, std::size_t{j} * 4);
    sums[0] += word;
    sums[1] += (j + 1) * word;
  }
  std::memcpy(message.data() + 8, sums, 8);
  return message;
}

}  // namespace weft::test
