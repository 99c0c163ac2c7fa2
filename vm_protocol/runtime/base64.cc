#include "vm_protocol/runtime/base64.h"

#include <openssl/evp.h>

namespace vm {

std::optional<std::string> DecodeBase64(std::string_view text) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 30;
  if (text.size() > kMaxBytes) return {};
  std::string signs;
  signs.reserve(text.size() + 3);
  for (const char c : text) {
    if (c != ' ' && c != '\t' && c != '\r' && c != '\n') signs += c;
  }
  const std::size_t end = signs.find_last_not_of('=') + 1;  // 0 if there is nothing else
  if (signs.size() - end > 2 || (end < signs.size() && signs.size() % 4 != 0)) return {};
  signs.resize(end);
  // OpenSSL takes '=' anywhere, and calls what '=' stands for bytes of 0.
  if (signs.find('=') != std::string::npos || signs.size() % 4 == 1) return {};
  const std::size_t missing = (4 - signs.size() % 4) % 4;
  signs.append(missing, '=');
  std::string bytes(signs.size() / 4 * 3, '\0');
  const int size = EVP_DecodeBlock(reinterpret_cast<unsigned char*>(bytes.data()),
                                   reinterpret_cast<const unsigned char*>(signs.data()),
                                   static_cast<int>(signs.size()));
  if (size < 0) return {};
  bytes.resize(static_cast<std::size_t>(size) - missing);
  return bytes;
}

std::string EncodeBase64(std::string_view bytes) {
  std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');  // and a zero that OpenSSL writes
  EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                  reinterpret_cast<const unsigned char*>(bytes.data()),
                  static_cast<int>(bytes.size()));
  text.pop_back();
  return text;
}

}  // namespace vm
