// Encodes text as a QR code, so that a phone can open an address by its camera.

#include "server/commands/qr_code.h"

#include <cstddef>
#include <cstdint>
#include <qrcodegen/qrcodegen.hpp>

namespace weft::server {
namespace {

constexpr int kQuiet = 4;  // modules of light around the code
// Of a larger code two rows a line no longer fit a terminal.
constexpr int kLeastVersion = 1, kMostVersion = 5;
constexpr int kAnyMask = -1;

}  // namespace

std::optional<QrCode> qr_code(std::string_view text) {
  using qrcodegen::QrSegment;
  try {
    const auto code = qrcodegen::QrCode::encodeSegments(
        {QrSegment::makeBytes(std::vector<std::uint8_t>(text.begin(), text.end()))},
        qrcodegen::QrCode::Ecc::LOW, kLeastVersion, kMostVersion, kAnyMask, false);
    QrCode rows;
    for (int y = 0; y < code.getSize(); ++y) {
      auto& row = rows.emplace_back();
      for (int x = 0; x < code.getSize(); ++x) row.push_back(code.getModule(x, y));
    }
    return rows;
  } catch (const qrcodegen::data_too_long&) {
    return std::nullopt;
  }
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
