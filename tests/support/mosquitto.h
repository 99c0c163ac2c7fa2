#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace support {

/// A port of 127.0.0.1 that was free a moment ago.
inline unsigned short FreePort() {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  const bool got = ::bind(fd, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                   ::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  ::close(fd);
  if (!got) throw std::runtime_error("no free port");
  return ntohs(address.sin_port);
}

/// The Mosquitto broker as a process on a port of its own. `settings`: lines of its configuration
/// beside the listener; without any, everybody may come in.
class Mosquitto {
 public:
  static bool Installed() {
    return std::system("PATH=$PATH:/usr/sbin command -v mosquitto >/dev/null 2>&1") == 0;
  }
  explicit Mosquitto(const std::string& settings = "allow_anonymous true\n")
      : port_(FreePort()), settings_(settings) {
    Start();
  }
  void Start() {
    const std::string file = folder_ / "mosquitto.conf";
    // Started as root it would become somebody who may not read our files.
    std::ofstream(file) << "listener " << port_ << " 127.0.0.1\nset_tcp_nodelay true\n"
                        << (geteuid() == 0 ? "user root\n" : "") << settings_;
    process_ = std::make_unique<Process>(std::vector<std::string>{
        "/bin/sh", "-c", "PATH=$PATH:/usr/sbin exec mosquitto -c " + file});
    SocketClient::Tcp(port_);  // waits until it listens
  }
  void Stop() { process_.reset(); }
  unsigned short port() const { return port_; }

 private:
  TempDir folder_;
  unsigned short port_;
  std::string settings_;
  std::unique_ptr<Process> process_;
};

}  // namespace support
