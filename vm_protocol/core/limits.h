#pragma once

#include <cstddef>

/// The named limits of the protocol. docs/protocol.md lists them with what happens beyond each.
namespace vm {

inline constexpr std::size_t kMaxLineBytes = 64u * 1024;  ///< one line, newline excluded
inline constexpr std::size_t kMaxNameBytes = 128;         ///< one slot path
inline constexpr std::size_t kMaxModuleNameBytes = 64;    ///< one @NAME
inline constexpr std::size_t kMaxReceivers = 32;          ///< names after one `to`
inline constexpr std::size_t kMaxTagBytes = 32;           ///< a request tag
inline constexpr std::size_t kMaxUserSlots = 1024;        ///< slots made by `def`, per module
inline constexpr std::size_t kMaxMacroLines = 1024;       ///< lines of one macro or command file
inline constexpr std::size_t kMaxMacroDepth = 16;         ///< `do` within `do`
inline constexpr std::size_t kMaxDoLines =
    16u * 1024;                                    ///< lines run by one `do`, nested ones included
inline constexpr std::size_t kMaxSavedSets = 256;  ///< sets kept by `save`, per module
inline constexpr std::size_t kMaxKeptBytes = 16u << 20;    ///< of what `def` and `save` keep
inline constexpr std::size_t kMaxErrorPeers = 1024;        ///< who asked for `prop Error`
inline constexpr std::size_t kMaxPhonemes = 8192;          ///< items of one phoneme list
inline constexpr std::size_t kMaxConnections = 64;         ///< clients of one module
inline constexpr std::size_t kMaxBacklogBytes = 4u << 20;  ///< unsent output kept for one reader

}  // namespace vm
