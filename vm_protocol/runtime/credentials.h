#pragma once

#include <string>

#include "vm_protocol/core/result.h"

namespace vm {

struct Endpoint;

/// What one side of a connection shows and asks of the other. Files, named; all may be empty.
struct Credentials {
  std::string token_file;   ///< a secret both sides have: its first line, kMinTokenBytes at least
  std::string certificate;  ///< PEM: what we show (a chain is possible), and its key
  std::string key;
  std::string authority;  ///< PEM: who signs for those we trust. At a listener: it asks for
                          ///< certificates
  bool operator==(const Credentials&) const = default;
};

inline constexpr std::size_t kMinTokenBytes = 16;

/// The first line of a file only its owner can read. kUnavailable: unreadable, open to others, or
/// shorter than `least_bytes`; `what` names it in the sentence ("token").
Result<std::string> ReadSecret(const std::string& path, const std::string& what,
                               std::size_t least_bytes);
/// The token, "" where no file is named. kUnavailable: unreadable, too short, or readable for
/// others than its owner.
Result<std::string> ReadToken(const Credentials& credentials);

/// True for addresses only this machine reaches: Unix sockets, 127.0.0.0/8, ::1, localhost.
bool IsLoopback(const Endpoint& endpoint);
/// kAccess with a sentence for a place other machines reach where nothing is asked of them.
Result<void> CheckListening(const Endpoint& endpoint, const Credentials& credentials);

// The proof that both sides know the token, without sending it: docs/protocol.md "Tokens".
std::string MakeNonce();
/// HMAC-SHA-256 over the role ("caller", "listener") and both nonces; hexadecimal.
std::string TokenProof(const std::string& token, const std::string& role,
                       const std::string& listener_nonce, const std::string& caller_nonce);
/// Takes as long for a wrong proof as for a right one.
bool SameProof(const std::string& a, const std::string& b);

}  // namespace vm
