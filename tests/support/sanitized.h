#pragma once

namespace support {

/// True in builds with the address sanitizer, which keeps freed memory for a while, and whose
/// undefined-behaviour half needs descriptors of its own: limits of either are not tested there.
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace support
