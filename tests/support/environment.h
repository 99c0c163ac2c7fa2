#pragma once

#include <string>

/// The environment in which every test runs, by ctest or by hand: nothing of the user's is in it.
namespace support {

/// For its lifetime the process, and what it starts, has an empty HOME and TMPDIR of its own, and
/// of the environment it was started with only what names tools, data and how to test (see
/// environment.cc). Throws std::runtime_error if the folder cannot be made.
class PrivateEnvironment {
 public:
  PrivateEnvironment();
  PrivateEnvironment(const PrivateEnvironment&) = delete;
  ~PrivateEnvironment();

 private:
  std::string folder_;
};

}  // namespace support
