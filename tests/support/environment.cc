#include "tests/support/environment.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <vector>

extern "C" char** environ;

namespace support {
namespace {

/// What a test may know of where it was started; one that ends with '*' stands for all that begin
/// so.
constexpr std::string_view kKept[] = {
    "PATH",           "LD_LIBRARY_PATH",  "LD_PRELOAD",                         // programs
    "GTEST_*",        "ASAN_OPTIONS",     "LSAN_OPTIONS",      "TSAN_OPTIONS",  // how to test
    "UBSAN_OPTIONS",  "GCOV_*",           "LLVM_PROFILE_FILE", "GALATEA_RENEW_GOLDENS",
    "GALATEA_HEADS",  "GALATEA_HTSVOICE", "GALATEA_NETWORKS",  "GALATEA_ORIGINAL",  // data
    "GALATEA_PHOTOS",
};

bool IsKept(std::string_view name) {
  return std::ranges::any_of(kKept, [&](std::string_view kept) {
    return kept.ends_with('*') ? name.starts_with(kept.substr(0, kept.size() - 1)) : name == kept;
  });
}

std::string Value(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

}  // namespace

PrivateEnvironment::PrivateEnvironment() {
  char folder[] = "/tmp/galatea-test-XXXXXX";
  if (::mkdtemp(folder) == nullptr) {
    throw std::runtime_error("no folder for a test: " + std::string(std::strerror(errno)));
  }
  folder_ = folder;
  // The networks are data that scripts/face_networks.sh puts into the user's cache.
  const std::string cache = Value("XDG_CACHE_HOME");
  const std::string networks =
      (cache.empty() ? Value("HOME") + "/.cache" : cache) + "/galatea/networks";

  std::vector<std::string> dropped;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    std::string name(*entry, std::strcspn(*entry, "="));
    if (!IsKept(name)) dropped.push_back(std::move(name));
  }
  for (const std::string& name : dropped) ::unsetenv(name.c_str());
  ::setenv("GALATEA_NETWORKS", networks.c_str(), 0);
  // Mesa looks for compiled shaders in the folder of the user's account, whatever HOME says. The
  // tests share those of one folder: compiling them is most of what a program that draws does at
  // its start.
  std::filesystem::create_directories(GALATEA_SHADERS_DIR);
  ::setenv("MESA_SHADER_CACHE_DIR", GALATEA_SHADERS_DIR, 1);
  for (const char* name : {"HOME", "TMPDIR"}) {
    const std::string own = folder_ + "/" + name;
    std::filesystem::create_directory(own);
    ::setenv(name, own.c_str(), 1);
  }
}

PrivateEnvironment::~PrivateEnvironment() {
  std::error_code error;
  std::filesystem::remove_all(folder_, error);
}

}  // namespace support
