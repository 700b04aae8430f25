#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weft::server {

/// The modules of a QR code, true where they are dark, row by row.
using QrCode = std::vector<std::vector<bool>>;

/// A QR code (ISO/IEC 18004) of versions 1 to 5 with error correction of level L, which restores 7
/// %.
/// @param text  bytes, as they are
/// @return nothing for more than 106 bytes
std::optional<QrCode> qr_code(std::string_view text);

/// The code for a terminal: two rows a line, black on white whatever the terminal's colours, with
/// the light border of four modules that readers need.
std::string terminal_text(const QrCode& code);

}  // namespace weft::server
