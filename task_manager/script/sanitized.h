#pragma once

// Whether the address or thread sanitizer, which have a malloc of their own, are built in.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define GALATEA_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define GALATEA_SANITIZED 1
#endif
#endif
