#include "proto/binary.h"

#include <algorithm>
#include <string>
#include <utility>

namespace weft::proto {
namespace {

constexpr std::size_t kLengthOffset = 4;
constexpr std::size_t kSumOffset = 8;

struct Sums {
  std::uint32_t a = 0, b = 0;
  bool operator==(const Sums&) const = default;
};

// Both sums over all words, with the sums' own words taken as 0. The size is a multiple of 4.
Sums checksum(std::span<const std::byte> message) {
  Sums sums;
  const std::size_t words = message.size() / sizeof(std::uint32_t);
  const auto add = [&sums, message](std::size_t first, std::size_t last) {
    for (std::size_t j = first; j < last; ++j) {
      const auto word = read_at<std::uint32_t>(message, j * sizeof(std::uint32_t));
      sums.a += word;
      sums.b += word * static_cast<std::uint32_t>(j + 1);
    }
  };
  add(0, kSumOffset / sizeof(std::uint32_t));
  add(kCommonBytes / sizeof(std::uint32_t), words);
  return sums;
}

bool all_zero(std::span<const std::byte> bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; });
}

}  // namespace

Error binary_error(std::string message) {
  return make_error(ErrorCode::bad_binary, std::move(message));
}

BinaryWriter::BinaryWriter(Bytes& out, BinaryType type, std::uint8_t codec, std::uint8_t flags)
    : out_(out) {
  out_.clear();
  put(BinaryHeader{type, kBinaryVersion, codec, flags, 0, 0, 0});
}

void BinaryWriter::append(std::span<const std::byte> bytes) {
  const std::size_t end = out_.size();
  out_.resize(end + bytes.size());
  if (!bytes.empty()) std::memcpy(out_.data() + end, bytes.data(), bytes.size());
}

void BinaryWriter::pad() {
  out_.resize(padded(out_.size()));
}

void BinaryWriter::finish() {
  pad();
  seal(out_);
}

void seal(std::span<std::byte> message) {
  const auto length = static_cast<std::uint32_t>(message.size());
  std::memcpy(message.data() + kLengthOffset, &length, sizeof length);
  const Sums sums = checksum(message);
  std::memcpy(message.data() + kSumOffset, &sums, sizeof sums);
}

Result<BinaryHeader> read_header(std::span<const std::byte> message, BinaryType type,
                                 std::size_t least_bytes, std::uint8_t last_codec) {
  if (message.size() < least_bytes) return binary_error("the message is too short");
  const auto header = read_at<BinaryHeader>(message, 0);
  if (header.type != type) return binary_error("the message is of another type");
  if (header.version != kBinaryVersion) return binary_error("unknown version");
  if (header.codec > last_codec) return binary_error("unknown codec");
  if (header.length != message.size() || header.length % kAlignment != 0)
    return binary_error("the length does not match");
  if (checksum(message) != Sums{header.sum_a, header.sum_b})
    return binary_error("the checksum does not match");
  return header;
}

Result<std::vector<Section>> read_sections(std::span<const std::byte> message, std::size_t offset,
                                           std::uint32_t count) {
  std::span<const std::byte> rest = message.subspan(offset);
  // Limits the reservation by the bytes at hand.
  if (count > rest.size() / kSectionHeaderBytes) return binary_error("too many sections");
  std::vector<Section> sections;
  sections.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (rest.size() < kSectionHeaderBytes) return binary_error("a section is cut off");
    const auto header = read_at<SectionHeader>(rest, 0);
    rest = rest.subspan(kSectionHeaderBytes);
    if (header.length > rest.size()) return binary_error("a section is too long");
    const std::size_t whole = padded(header.length);  // fits: the rest is a multiple of kAlignment
    if (!all_zero(rest.subspan(header.length, whole - header.length)))
      return binary_error("padding is not zero");
    sections.push_back({header.kind, header.index, rest.first(header.length)});
    rest = rest.subspan(whole);
  }
  if (!rest.empty()) return binary_error("bytes are left over");
  std::vector<std::pair<std::uint16_t, std::uint16_t>> names;
  names.reserve(sections.size());
  for (const Section& section : sections) names.emplace_back(section.kind, section.index);
  std::sort(names.begin(), names.end());
  if (std::adjacent_find(names.begin(), names.end()) != names.end())
    return binary_error("a section appears twice");
  return sections;
}

}  // namespace weft::proto
