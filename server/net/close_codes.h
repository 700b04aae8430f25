#pragma once

#include <cstdint>

namespace weft::server {

// WebSocket close codes that the server uses; proto/README.md section 9.
inline constexpr std::uint16_t kCloseGoingAway = 1001;
inline constexpr std::uint16_t kCloseNotAnAck = 1003;
inline constexpr std::uint16_t kClosePolicy = 1008;
inline constexpr std::uint16_t kCloseTooLarge = 1009;
inline constexpr std::uint16_t kCloseFault = 1011;
inline constexpr std::uint16_t kCloseViewerDoesNotRead = 4000;
inline constexpr std::uint16_t kCloseNoPong = 4001;
inline constexpr std::uint16_t kCloseToken = 4003;
inline constexpr std::uint16_t kCloseRoomClosed = 4004;

}  // namespace weft::server
