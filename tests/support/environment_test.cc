#include "tests/support/environment.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace support {
namespace {

constexpr const char* kUsers[] = {
    "GALATEA_FACES",   "XDG_DATA_HOME", "XDG_CACHE_HOME",   "XDG_CONFIG_HOME",
    "XDG_RUNTIME_DIR", "DISPLAY",       "WAYLAND_DISPLAY",  "NOTIFY_SOCKET",
    "WATCHDOG_USEC",   "LANG",          "LC_ALL",           "TZ",
    "http_proxy",      "HTTPS_PROXY",   "ALSA_CONFIG_PATH", "LIBGL_ALWAYS_SOFTWARE",
    "GALATEA_BIN"};

std::string Value(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "not set";
}

/// The variables and folders of the user that a test would see here; empty where there are none.
std::string SeenOfTheUser() {
  std::string seen;
  for (const char* name : kUsers) {
    if (std::getenv(name) != nullptr) seen += std::string(name) + " = " + Value(name) + "\n";
  }
  for (const char* name : {"HOME", "TMPDIR"}) {
    const std::string folder = Value(name);
    if (!folder.starts_with("/tmp/galatea-test-") || !std::filesystem::is_empty(folder)) {
      seen += std::string(name) + " = " + folder + "\n";
    }
  }
  return seen;
}

TEST(EnvironmentTest, ATestSeesNothingOfTheUser) { EXPECT_EQ(SeenOfTheUser(), ""); }

TEST(EnvironmentTest, WhatTheUserHasIsLeftOut) {
  const auto child = [] {
    for (const char* name : kUsers) ::setenv(name, "/users", 1);
    ::setenv("HOME", "/users", 1);
    std::string seen;
    {
      const PrivateEnvironment environment;
      seen = SeenOfTheUser();
    }
    std::fprintf(stderr, "[%s]", seen.c_str());
    std::_Exit(seen.empty() ? 0 : 1);
  };
  EXPECT_EXIT(child(), testing::ExitedWithCode(0), "\\[\\]");
}

TEST(EnvironmentTest, TheNetworksInTheUsersCacheAndNamedDataAreStillFound) {
  const auto child = [](const char* cache) {
    ::unsetenv("GALATEA_NETWORKS");
    ::unsetenv("XDG_CACHE_HOME");
    ::setenv("HOME", "/home/users", 1);
    ::setenv("GALATEA_PHOTOS", "/photos", 1);
    if (cache != nullptr) ::setenv("XDG_CACHE_HOME", cache, 1);
    {
      const PrivateEnvironment environment;
      std::fprintf(stderr, "%s %s", Value("GALATEA_NETWORKS").c_str(),
                   Value("GALATEA_PHOTOS").c_str());
    }
    std::_Exit(0);
  };
  EXPECT_EXIT(child(nullptr), testing::ExitedWithCode(0),
              "^/home/users/.cache/galatea/networks /photos$");
  EXPECT_EXIT(child("/cache"), testing::ExitedWithCode(0), "^/cache/galatea/networks /photos$");
}

TEST(EnvironmentTest, ItsFolderGoesWithIt) {
  const auto child = [] {
    std::string home;
    {
      const PrivateEnvironment environment;
      home = Value("HOME");
      std::filesystem::create_directories(home + "/.local/share");
    }
    std::_Exit(std::filesystem::exists(std::filesystem::path(home).parent_path()) ? 1 : 0);
  };
  EXPECT_EXIT(child(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace support
