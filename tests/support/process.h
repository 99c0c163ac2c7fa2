#pragma once

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#ifdef __linux__
#include <sys/prctl.h>
#endif

/// Few verbs for tests of real programs: spawn, write, read, expect, terminate, kill, wait.
/// Thread: one. Every wait has a time limit, so a broken program fails a test and never hangs it.
namespace support {

using Millis = std::chrono::milliseconds;
inline constexpr Millis kPatience{20000};  ///< far beyond what any answer takes on a busy machine

/// Whether `holds`, asked again and again, says so within `patience`.
template <typename Condition>
bool Becomes(Condition holds, Millis patience = kPatience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
  }
  return true;
}

/// Lines over a descriptor to read and one to write (which may be the same). Owns both.
class LineStream {
 public:
  LineStream() = default;
  LineStream(int read_fd, int write_fd) : read_fd_(read_fd), write_fd_(write_fd) {
    std::signal(SIGPIPE, SIG_IGN);
  }
  LineStream(const LineStream&) = delete;
  LineStream& operator=(const LineStream&) = delete;
  virtual ~LineStream() { CloseStreams(); }

  /// False if the other side is gone.
  bool Write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::write(write_fd_, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
  }
  bool WriteLine(std::string_view line) { return Write(std::string(line) + "\n"); }

  /// End of input for the program. (A socket is shut down in that direction.)
  void CloseInput() {
    if (write_fd_ < 0) return;
    if (write_fd_ == read_fd_) {
      ::shutdown(write_fd_, SHUT_WR);
    } else {
      ::close(write_fd_);
    }
    write_fd_ = -1;
  }

  /// The next line without its newline; none at the time limit or at the end (see AtEnd).
  std::optional<std::string> ReadLine(Millis patience = kPatience) {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (lines_.empty() && !at_end_) {
      const auto left = std::chrono::ceil<Millis>(deadline - std::chrono::steady_clock::now());
      if (left.count() < 0 || !Pump(left)) return std::nullopt;
    }
    if (lines_.empty()) return std::nullopt;
    std::string line = std::move(lines_.front());
    lines_.pop_front();
    seen_.push_back(line);
    return line;
  }

  /// Reads on until a line contains `part` and returns it; none at the time limit or the end.
  std::optional<std::string> Expect(std::string_view part, Millis patience = kPatience) {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (true) {
      const auto left = std::chrono::ceil<Millis>(deadline - std::chrono::steady_clock::now());
      std::optional<std::string> line = ReadLine(std::max(left, Millis{0}));
      if (!line) return std::nullopt;
      if (line->find(part) != std::string::npos) return line;
    }
  }

  /// Reads on until lines with all of these parts have come, in whatever order.
  bool ExpectAll(std::vector<std::string> parts, Millis patience = kPatience) {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (!parts.empty()) {
      const auto left = std::chrono::ceil<Millis>(deadline - std::chrono::steady_clock::now());
      const std::optional<std::string> line = ReadLine(std::max(left, Millis{0}));
      if (!line) return false;
      std::erase_if(parts, [&](const std::string& part) { return line->contains(part); });
    }
    return true;
  }

  /// All further lines until the end of the stream or the time limit.
  std::vector<std::string> ReadAll(Millis patience = kPatience) {
    std::vector<std::string> all;
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (true) {
      const auto left = std::chrono::ceil<Millis>(deadline - std::chrono::steady_clock::now());
      std::optional<std::string> line = ReadLine(std::max(left, Millis{0}));
      if (!line) return all;
      all.push_back(std::move(*line));
    }
  }

  bool AtEnd() const { return at_end_ && lines_.empty(); }
  /// Every line read so far, for messages of failing tests.
  std::string Seen() const {
    std::string text;
    for (const std::string& line : seen_) text += line + "\n";
    return text;
  }

 protected:
  void Attach(int read_fd, int write_fd) {
    read_fd_ = read_fd;
    write_fd_ = write_fd;
    std::signal(SIGPIPE, SIG_IGN);
  }
  void CloseStreams() {
    if (read_fd_ >= 0) ::close(read_fd_);
    if (write_fd_ >= 0 && write_fd_ != read_fd_) ::close(write_fd_);
    read_fd_ = write_fd_ = -1;
  }
  /// A second descriptor read along with the lines (a program's stderr), so that it never blocks.
  int error_fd_ = -1;
  std::string error_text_;

  /// Reads what is there, waiting at most `patience`. False if nothing came.
  bool Pump(Millis patience) {
    pollfd polls[2] = {{at_end_ ? -1 : read_fd_, POLLIN, 0}, {error_fd_, POLLIN, 0}};
    const int ready = ::poll(polls, 2, static_cast<int>(patience.count()));
    if (ready <= 0) return ready < 0 && errno == EINTR;
    char buffer[65536];
    if (polls[1].revents != 0) {
      const ssize_t n = ::read(error_fd_, buffer, sizeof buffer);
      if (n > 0) {
        error_text_.append(buffer, static_cast<std::size_t>(n));
      } else {
        ::close(error_fd_);
        error_fd_ = -1;
      }
    }
    if (polls[0].revents != 0) {
      const ssize_t n = ::read(read_fd_, buffer, sizeof buffer);
      if (n > 0) {
        partial_.append(buffer, static_cast<std::size_t>(n));
      } else {
        at_end_ = true;
        if (!partial_.empty()) partial_ += '\n';
      }
      for (std::size_t end; (end = partial_.find('\n')) != std::string::npos;) {
        lines_.push_back(partial_.substr(0, end));
        partial_.erase(0, end + 1);
      }
    }
    return true;
  }

 private:
  int read_fd_ = -1;
  int write_fd_ = -1;
  std::string partial_;
  std::deque<std::string> lines_;
  std::vector<std::string> seen_;
  bool at_end_ = false;
};

/// A program with its stdin, stdout and stderr in our hands. It is killed when this goes away.
class Process : public LineStream {
 public:
  struct Options {
    std::string cwd;               ///< empty = ours
    std::vector<std::string> env;  ///< "NAME=VALUE", added to ours
  };

  /// Throws std::runtime_error if it cannot be started. argv[0] is looked up in PATH.
  explicit Process(const std::vector<std::string>& argv) : Process(argv, Options()) {}
  Process(const std::vector<std::string>& argv, const Options& options) {
    int in[2], out[2], err[2];
    if (::pipe2(in, O_CLOEXEC) != 0 || ::pipe2(out, O_CLOEXEC) != 0 ||
        ::pipe2(err, O_CLOEXEC) != 0) {
      throw std::runtime_error("pipe: " + std::string(std::strerror(errno)));
    }
    std::vector<char*> args;
    for (const std::string& arg : argv) args.push_back(const_cast<char*>(arg.c_str()));
    args.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ < 0) throw std::runtime_error("fork: " + std::string(std::strerror(errno)));
    if (pid_ == 0) {
      ::dup2(in[0], 0);
      ::dup2(out[1], 1);
      ::dup2(err[1], 2);
      std::signal(SIGPIPE, SIG_DFL);
#ifdef __linux__
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
      for (const std::string& entry : options.env) ::putenv(const_cast<char*>(entry.c_str()));
      if (!options.cwd.empty() && ::chdir(options.cwd.c_str()) != 0) ::_exit(126);
      ::execvp(args[0], args.data());
      ::dprintf(2, "%s: %s\n", args[0], std::strerror(errno));
      ::_exit(127);
    }
    ::close(in[0]);
    ::close(out[1]);
    ::close(err[1]);
    Attach(out[0], in[1]);
    error_fd_ = err[0];
  }
  ~Process() override {
    if (!status_) {
      Signal(SIGKILL);
      Wait(kPatience);
    }
    if (error_fd_ >= 0) ::close(error_fd_);
  }

  pid_t pid() const { return pid_; }
  void Signal(int signal) {
    if (!status_) ::kill(pid_, signal);
  }
  void Terminate() { Signal(SIGTERM); }
  void Kill() { Signal(SIGKILL); }

  /// Exit code, or 128 + the signal that ended it; none if it still runs at the time limit.
  /// Its output is taken meanwhile, so a talkative program can end.
  std::optional<int> Wait(Millis patience = kPatience) {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (!status_) {
      int status = 0;
      if (::waitpid(pid_, &status, WNOHANG) == pid_) {
        status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        while (Pump(Millis{0}) && error_fd_ >= 0) {
        }
        break;
      }
      if (std::chrono::steady_clock::now() > deadline) return std::nullopt;
      // Nothing tells of a child's end but polling (portably); output wakes us earlier.
      Pump(Millis{10});
    }
    return status_;
  }

  /// What it has written to stderr so far.
  const std::string& ErrorText() {
    while (error_fd_ >= 0 && Pump(Millis{0})) {
    }
    return error_text_;
  }
  /// Waits until stderr contains `part`. False at the time limit.
  bool ExpectError(std::string_view part, Millis patience = kPatience) {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (error_text_.find(part) == std::string::npos) {
      if (error_fd_ < 0 || std::chrono::steady_clock::now() > deadline) return false;
      Pump(Millis{50});
    }
    return true;
  }

 private:
  pid_t pid_ = -1;
  std::optional<int> status_;
};

/// A client of a socket. The server may still be starting: connecting is tried until the limit.
class SocketClient : public LineStream {
 public:
  /// Throws std::runtime_error at the time limit.
  static std::unique_ptr<SocketClient> Unix(const std::string& path, Millis patience = kPatience) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.size() >= sizeof address.sun_path) throw std::runtime_error("path too long: " + path);
    std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
    return Dial(AF_UNIX, reinterpret_cast<const sockaddr*>(&address), sizeof address, path,
                patience);
  }
  static std::unique_ptr<SocketClient> Tcp(unsigned short port, Millis patience = kPatience) {
    addrinfo hints{};
    hints.ai_family = AF_INET;
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const std::string service = std::to_string(port);
    if (::getaddrinfo("127.0.0.1", service.c_str(), &hints, &found) != 0) {
      throw std::runtime_error("no address for 127.0.0.1:" + service);
    }
    sockaddr_storage address{};
    const socklen_t size = found->ai_addrlen;
    std::memcpy(&address, found->ai_addr, size);
    ::freeaddrinfo(found);
    return Dial(AF_INET, reinterpret_cast<const sockaddr*>(&address), size, service, patience);
  }

 private:
  static std::unique_ptr<SocketClient> Dial(int family, const sockaddr* address, socklen_t size,
                                            const std::string& name, Millis patience) {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (true) {
      const int fd = ::socket(family, SOCK_STREAM | SOCK_CLOEXEC, 0);
      if (::connect(fd, address, size) == 0) {
        std::unique_ptr<SocketClient> client(new SocketClient());
        client->Attach(fd, fd);
        return client;
      }
      const int why = errno;
      ::close(fd);
      if (std::chrono::steady_clock::now() > deadline) {
        throw std::runtime_error(name + ": " + std::strerror(why));
      }
      ::poll(nullptr, 0, 5);
    }
  }
};

/// A private folder, removed with all in it at the end of the test.
class TempDir {
 public:
  TempDir() {
    char name[] = "/tmp/galatea-test-XXXXXX";
    if (::mkdtemp(name) == nullptr) throw std::runtime_error("mkdtemp failed");
    path_ = name;
  }
  TempDir(const TempDir&) = delete;
  ~TempDir() {
    const std::string command = "rm -rf '" + path_ + "'";
    if (std::system(command.c_str()) != 0) return;
  }
  const std::string& path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace support
