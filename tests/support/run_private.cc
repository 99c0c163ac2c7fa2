// Runs a command in the environment of the tests:  test_in_private_environment COMMAND ARGUMENTS...

#include <spawn.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstring>

#include "tests/support/environment.h"

extern "C" char** environ;

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const support::PrivateEnvironment environment;
  pid_t child = 0;
  if (const int error = ::posix_spawnp(&child, argv[1], nullptr, nullptr, argv + 1, environ)) {
    std::fprintf(stderr, "%s: %s\n", argv[1], std::strerror(error));
    return 127;
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}
