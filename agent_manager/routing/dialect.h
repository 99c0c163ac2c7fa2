#pragma once

namespace am {

/// Whether a module knows tags, @T and the Clock slot. kAuto: the hub finds out by asking for
/// Clock.
enum class Dialect { kAuto, kModern, kOriginal };

}  // namespace am
