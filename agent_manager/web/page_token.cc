#include "agent_manager/web/page_token.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "vm_protocol/core/user_folder.h"
#include "vm_protocol/runtime/credentials.h"

namespace am {
namespace {

namespace fs = std::filesystem;

/// Writes beside `path` and renames, so that no reader meets half a token.
void Write(const fs::path& path, const std::string& token) {
  const std::string beside = path.string() + ".new";
  unlink(beside.c_str());
  const int file = open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file < 0) return;
  const std::string line = token + "\n";
  const bool whole = write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  close(file);
  if (!whole || rename(beside.c_str(), path.c_str()) != 0) unlink(beside.c_str());
}

}  // namespace

std::string KeptToken(unsigned short port) {
  const fs::path folder = vm::UserFolder("XDG_STATE_HOME", ".local/state");
  if (folder.empty()) return vm::MakeNonce();
  std::error_code failed;
  fs::create_directories(folder, failed);
  const fs::path path = folder / ("page_token_" + std::to_string(port));
  std::string token = vm::MakeNonce();
  if (const auto kept = vm::ReadSecret(path, "token", token.size())) return *kept;
  Write(path, token);
  return token;
}

}  // namespace am
