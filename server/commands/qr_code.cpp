// Encodes text as a QR code, so that a phone can open an address by its camera.

#include "server/commands/qr_code.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace weft::server {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// How many codewords a version has at level L, all in one block.
struct Version {
  std::size_t data, correction;
};
constexpr std::array<Version, 5> kVersions = {{{19, 7}, {34, 10}, {55, 15}, {80, 20}, {108, 26}}};
constexpr std::size_t kHeadBits = 12;  // mode and count of bytes
constexpr unsigned kByteMode = 4;
constexpr std::array<std::uint8_t, 2> kPadding = {0xec, 0x11};
constexpr unsigned kField = 0x11d;  // x^8 + x^4 + x^3 + x^2 + 1, of the field of 256 elements
constexpr int kQuiet = 4;           // modules of light around the code
// Level L and mask 0, with their own error correction. Mask 0 is a checkerboard. The standard
// prefers the mask that leaves the fewest large areas, but readers take any.
constexpr unsigned kFormat = 0x77c4;
constexpr int kFormatBits = 15;

std::uint8_t product(unsigned a, unsigned b) {
  unsigned sum = 0;
  for (; b != 0; b >>= 1) {
    if ((b & 1) != 0) sum ^= a;
    a <<= 1;
    if ((a & 0x100) != 0) a ^= kField;
  }
  return static_cast<std::uint8_t>(sum);
}

/// The generator of a Reed-Solomon code with so many roots, highest power first, without its
/// leading 1.
Bytes generator(std::size_t degree) {
  Bytes polynomial(degree, 0);
  polynomial.back() = 1;
  std::uint8_t root = 1;
  for (std::size_t k = 0; k < degree; ++k) {
    for (std::size_t i = 0; i < degree; ++i) {
      polynomial[i] = product(polynomial[i], root);
      if (i + 1 < degree) polynomial[i] ^= polynomial[i + 1];
    }
    root = product(root, 2);
  }
  return polynomial;
}

/// What is left of the data, divided by the generator.
Bytes correction_of(const Bytes& data, std::size_t degree) {
  const Bytes divisor = generator(degree);
  Bytes rest(degree, 0);
  for (const std::uint8_t byte : data) {
    const std::uint8_t factor = byte ^ rest.front();
    std::rotate(rest.begin(), rest.begin() + 1, rest.end());
    rest.back() = 0;
    for (std::size_t i = 0; i < degree; ++i) rest[i] ^= product(divisor[i], factor);
  }
  return rest;
}

void append_bits(std::vector<bool>& bits, unsigned value, int count) {
  for (int k = count - 1; k >= 0; --k) bits.push_back(((value >> k) & 1U) != 0);
}

/// Data and correction of a text, bit by bit. The text fits.
std::vector<bool> codewords(std::string_view text, const Version& version) {
  std::vector<bool> bits;
  append_bits(bits, kByteMode, 4);
  append_bits(bits, static_cast<unsigned>(text.size()), 8);
  for (const char c : text) append_bits(bits, static_cast<std::uint8_t>(c), 8);
  const std::size_t room = 8 * version.data;
  assert(bits.size() <= room);
  bits.resize(std::min(room, bits.size() + 4));  // its end
  bits.resize((bits.size() + 7) / 8 * 8);
  for (std::size_t k = 0; bits.size() < room; ++k) append_bits(bits, kPadding[k % 2], 8);
  Bytes data(version.data, 0);
  for (std::size_t k = 0; k < bits.size(); ++k)
    data[k / 8] = static_cast<std::uint8_t>(data[k / 8] << 1 | static_cast<int>(bits[k]));
  for (const std::uint8_t byte : correction_of(data, version.correction))
    append_bits(bits, byte, 8);
  return bits;
}

/// The square of modules while it is filled; what does not depend on the text is fixed first.
class Drawing {
 public:
  explicit Drawing(int version)
      : size_(17 + 4 * version), dark_(cells(), false), fixed_(cells(), false) {
    for (int k = 0; k < size_; ++k) {  // timing
      fix(6, k, k % 2 == 0);
      fix(k, 6, k % 2 == 0);
    }
    for (const auto& [x, y] : {std::pair{3, 3}, {size_ - 4, 3}, {3, size_ - 4}}) draw_finder(x, y);
    if (version > 1) draw_rings(size_ - 7, size_ - 7, 2);
    draw_format();
  }

  /// Fills in the text's bits, in columns of two from the right, up and down, masked.
  void fill(const std::vector<bool>& bits) {
    std::size_t next = 0;
    bool up = true;
    for (int right = size_ - 1; right > 0; right -= 2, up = !up) {
      if (right == 6) right = 5;  // the timing has this column alone
      for (int k = 0; k < size_; ++k) {
        for (const int x : {right, right - 1}) {
          const int y = up ? size_ - 1 - k : k;
          if (fixed_[at(x, y)]) continue;
          const bool bit = next < bits.size() && bits[next++];
          dark_[at(x, y)] = bit != ((x + y) % 2 == 0);
        }
      }
    }
    assert(next == bits.size());
  }

  QrCode modules() const {
    QrCode rows;
    for (int y = 0; y < size_; ++y)
      rows.emplace_back(dark_.begin() + y * size_, dark_.begin() + (y + 1) * size_);
    return rows;
  }

 private:
  std::size_t cells() const { return static_cast<std::size_t>(size_ * size_); }
  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y * size_ + x); }
  void fix(int x, int y, bool dark) {
    if (x < 0 || y < 0 || x >= size_ || y >= size_) return;
    dark_[at(x, y)] = dark;
    fixed_[at(x, y)] = true;
  }
  /// Dark and light rings around a dark middle, out to a dark one.
  void draw_rings(int x, int y, int radius) {
    for (int dy = -radius; dy <= radius; ++dy)
      for (int dx = -radius; dx <= radius; ++dx) {
        const int ring = std::max(std::abs(dx), std::abs(dy));
        fix(x + dx, y + dy, ring == radius || ring + 2 <= radius);
      }
  }
  /// One of the three corners, with light around it.
  void draw_finder(int x, int y) {
    for (int dy = -4; dy <= 4; ++dy)
      for (int dx = -4; dx <= 4; ++dx) fix(x + dx, y + dy, false);
    draw_rings(x, y, 3);
  }
  /// The format, twice, and the module that is always dark.
  void draw_format() {
    const auto bit = [](int k) { return ((kFormat >> k) & 1U) != 0; };
    for (int k = 0; k < kFormatBits; ++k) {
      // Around the first corner, where the timing is left out.
      if (k < 8)
        fix(8, k < 6 ? k : k + 1, bit(k));
      else
        fix(k == 8 ? 7 : 14 - k, 8, bit(k));
      // Beside the two others.
      if (k < 8)
        fix(size_ - 1 - k, 8, bit(k));
      else
        fix(8, size_ - 15 + k, bit(k));
    }
    fix(8, size_ - 8, true);
  }

  int size_;
  std::vector<bool> dark_, fixed_;
};

}  // namespace

std::optional<QrCode> qr_code(std::string_view text) {
  const std::size_t bits = kHeadBits + 8 * text.size();
  const auto* const version =
      std::find_if(kVersions.begin(), kVersions.end(),
                   [bits](const Version& each) { return bits <= 8 * each.data; });
  if (version == kVersions.end()) return std::nullopt;
  Drawing drawing(static_cast<int>(version - kVersions.begin()) + 1);
  drawing.fill(codewords(text, *version));
  return drawing.modules();
}

std::string terminal_text(const QrCode& code) {
  const int size = static_cast<int>(code.size());
  const auto dark = [&](int x, int y) {
    const bool inside = x >= 0 && y >= 0 && x < size && y < size;
    return inside && code[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
  };
  std::string text;
  for (int y = -kQuiet; y < size + kQuiet; y += 2) {
    text += "\x1b[30;107m";
    for (int x = -kQuiet; x < size + kQuiet; ++x) {
      const bool upper = dark(x, y), lower = dark(x, y + 1);
      text += upper && lower ? "█" : upper ? "▀" : lower ? "▄" : " ";
    }
    text += "\x1b[0m\n";
  }
  return text;
}

}  // namespace weft::server
