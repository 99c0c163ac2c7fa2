#include "vm_protocol/runtime/credentials.h"

#include <arpa/inet.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>
#include <sys/stat.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "vm_protocol/core/text_file.h"
#include "vm_protocol/runtime/endpoint.h"

namespace vm {
namespace {

constexpr std::size_t kMaxSecretBytes = 64U << 10;

std::string Hex(const unsigned char* bytes, std::size_t count) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += kDigits[bytes[i] >> 4];
    text += kDigits[bytes[i] & 15];
  }
  return text;
}

}  // namespace

Result<std::string> ReadSecret(const std::string& path, const std::string& what,
                               std::size_t least_bytes) {
  const auto text = ReadTextFile(path, kMaxSecretBytes);
  struct stat info {};
  if (!text || stat(path.c_str(), &info) != 0)
    return Fail(Errc::kUnavailable,
                "the " + what + " file: " + (text ? std::strerror(errno) : text.error().text));
  if ((info.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    return Fail(Errc::kUnavailable,
                "the " + what + " file '" + path + "' is open to others, expected mode 600");
  std::string secret = text->substr(0, text->find('\n'));
  while (!secret.empty() && (secret.back() == '\r' || secret.back() == ' ')) secret.pop_back();
  if (secret.size() < least_bytes)
    return Fail(Errc::kUnavailable, "the " + what + " in '" + path + "' is shorter than " +
                                        std::to_string(least_bytes) + " bytes");
  return secret;
}

Result<std::string> ReadToken(const Credentials& credentials) {
  if (credentials.token_file.empty()) return "";
  return ReadSecret(credentials.token_file, "token", kMinTokenBytes);
}

bool IsLoopback(const Endpoint& endpoint) {
  in_addr address{};
  const bool numeric = inet_pton(AF_INET, endpoint.host.c_str(), &address) == 1;
  constexpr std::uint32_t kLoopbackNet = 127;
  return endpoint.kind == Endpoint::Kind::kUnix || endpoint.host == "localhost" ||
         endpoint.host == "::1" || (numeric && ntohl(address.s_addr) >> 24 == kLoopbackNet);
}

Result<void> CheckListening(const Endpoint& endpoint, const Credentials& credentials) {
  if (endpoint.kind == Endpoint::Kind::kTls &&
      (credentials.certificate.empty() || credentials.key.empty()))
    return Fail(Errc::kAccess,
                FormatEndpoint(endpoint) + " needs a certificate and its key to show");
  const bool asks_certificates =
      endpoint.kind == Endpoint::Kind::kTls && !credentials.authority.empty();
  if (IsLoopback(endpoint) || asks_certificates || !credentials.token_file.empty()) return {};
  return Fail(Errc::kAccess, FormatEndpoint(endpoint) +
                                 " is open to other machines: it needs a token file, or tls: with "
                                 "an authority for certificates of those who come");
}

std::string MakeNonce() {
  std::array<unsigned char, 32> bytes{};
  if (RAND_bytes(bytes.data(), static_cast<int>(bytes.size())) != 1)
    throw std::runtime_error("the system has no random numbers");
  return Hex(bytes.data(), bytes.size());
}

std::string TokenProof(const std::string& token, const std::string& role,
                       const std::string& listener_nonce, const std::string& caller_nonce) {
  const std::string text = "galatea 1 " + role + " " + listener_nonce + " " + caller_nonce;
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  HMAC(EVP_sha256(), token.data(), static_cast<int>(token.size()),
       reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data(), &size);
  return Hex(digest.data(), size);
}

bool SameProof(const std::string& a, const std::string& b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

}  // namespace vm
