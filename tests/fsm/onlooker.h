#pragma once

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/process.h"

namespace fsm {

constexpr int kOnlookerLimitMs = 20000;  // never reached unless something is wrong

/// A program that looks on.
class Onlooker {
 public:
  Onlooker() : path_(folder_ / "socket") {
    listening_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path_.copy(address.sun_path, path_.size());
    EXPECT_EQ(::bind(listening_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(::listen(listening_, 1), 0);
  }
  ~Onlooker() {
    Close();
    ::close(listening_);
  }
  const std::string& path() const { return path_; }

  struct Record {
    std::string time;
    std::vector<std::uint8_t> jpeg;
  };
  /// The next record; nothing at the end.
  std::optional<Record> Next() {
    if (connection_ < 0) connection_ = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
    std::string head;
    for (char c = 0; c != '\n'; head += c) {
      if (!ReadAll(&c, 1)) return std::nullopt;
    }
    EXPECT_TRUE(head.starts_with("picture ")) << head;
    const std::size_t space = head.find(' ', 8);
    Record record{head.substr(8, space - 8), {}};
    record.jpeg.resize(std::stoul(head.substr(space)));
    if (!ReadAll(record.jpeg.data(), record.jpeg.size())) return std::nullopt;
    return record;
  }
  void Close() {
    if (connection_ >= 0) ::close(std::exchange(connection_, -1));
  }

 private:
  bool ReadAll(void* to, std::size_t size) {
    for (auto* at = static_cast<char*>(to); size > 0;) {
      pollfd wanted{connection_, POLLIN, 0};
      if (::poll(&wanted, 1, kOnlookerLimitMs) <= 0) return false;
      const ssize_t n = ::read(connection_, at, size);
      if (n <= 0) return false;
      at += n;
      size -= static_cast<std::size_t>(n);
    }
    return true;
  }

  support::TempDir folder_;
  std::string path_;
  int listening_ = -1, connection_ = -1;
};

}  // namespace fsm
