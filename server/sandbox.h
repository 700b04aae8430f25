#pragma once

namespace weft::server {

/// Whether a sanitizer is built in, which needs address space and system calls of its own.
#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
#else
inline constexpr bool kSanitized = false;
#endif

/// From now on this process may take memory, read and write what is open, and end; every other
/// system call fails with EPERM. Does nothing where the kernel, the processor or a sanitizer does
/// not allow it.
/// @return whether it holds
bool forbid_system_calls();

}  // namespace weft::server
