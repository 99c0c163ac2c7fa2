#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "vm_protocol/core/line_framing.h"
#include "vm_protocol/runtime/encoding.h"

namespace vm {

/// How a conversation has ended.
struct StreamEnd {
  bool orderly = false;  ///< the input has ended; Send works until Close, the output may be open
  std::string reason;    ///< for people
};

/// One conversation in lines over file descriptors: a pair of pipes, a terminal, a file, a socket.
/// Ownership: owns its descriptors and closes them (stdin/stdout are flushed but left open).
///            Kept alive by its pending operations; Close() or the end of both directions frees it.
/// Thread:    the io_context's; all callbacks run on it, none from within a call of ours.
/// Limits:    lines by LineReader; unsent output by kMaxBacklogBytes, beyond which the peer is too
///            slow and is closed ("backlog over ... bytes").
/// Errors:    a line that is too long comes as an error; everything else ends in on_close, once.
class StreamPeer : public std::enable_shared_from_this<StreamPeer> {
 public:
  using OnLine = std::function<void(Result<std::string_view> line)>;
  using OnClose = std::function<void(const StreamEnd& end)>;

  /// `read_fd` and `write_fd` may be the same (a socket). Takes both over; regular files are read
  /// without waiting.
  static std::shared_ptr<StreamPeer> Make(boost::asio::io_context& io, int read_fd, int write_fd,
                                          Framing framing, Encoding encoding = Encoding::kUtf8);
  virtual ~StreamPeer() = default;

  /// Bytes already read from `read_fd` by someone else; they come first. Before Start.
  virtual void Prefeed(std::string bytes) = 0;
  virtual void Start(OnLine on_line, OnClose on_close) = 0;
  /// Queues one line (without terminator) in the peer's framing and encoding.
  virtual void Send(std::string_view line) = 0;
  /// Keeps lines back while a quarter of kMaxBacklogBytes is unsent: for a program that answers
  /// what it hears, so that whoever asks faster than it reads waits. Before Start.
  virtual void HoldInputWhileBehind() = 0;
  /// Stops and resumes reading (back-pressure, `set Wait`). Lines already read are kept back too.
  virtual void PauseReading() = 0;
  virtual void ResumeReading() = 0;
  /// Calls `done` once everything sent so far has been handed to the system, or at close.
  virtual void Flush(std::function<void()> done) = 0;
  /// At once; unsent output is lost. on_close is not called.
  virtual void Close() = 0;
  virtual std::size_t backlog_bytes() const = 0;
};

/// While one lives on this thread, what stream peers are given to say is kept; they write when the
/// outermost one ends: one write for all that was said, and without another trip through the loop.
class WriteBatch {
 public:
  WriteBatch();
  ~WriteBatch();
  WriteBatch(const WriteBatch&) = delete;

 private:
  const bool outermost_;
};

}  // namespace vm
