#include "vm_protocol/runtime/stream_peer.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <cerrno>
#include <cstring>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace vm {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;

constexpr std::size_t kReadBytes = 64u * 1024;

/// Regular files and /dev/null are always ready, and cannot be waited for.
bool CanWaitFor(int fd) {
  struct stat info {};
  if (fstat(fd, &info) != 0 || S_ISREG(info.st_mode) || S_ISDIR(info.st_mode)) return false;
  struct stat null {};
  return !S_ISCHR(info.st_mode) || stat("/dev/null", &null) != 0 || info.st_rdev != null.st_rdev;
}

/// A descriptor with its old flags: Asio makes it non-blocking, and the standard streams are
/// shared with the shell that started us, which wants them back as they were.
struct StandardStream {
  int fd = -1;
  int flags = 0;
  ~StandardStream() {
    if (fd >= 0) fcntl(fd, F_SETFL, flags);
  }
};

class StreamPeerImpl;

/// The peers that were given something to say within the batch of this thread.
struct Batch {
  bool open = false;
  std::vector<std::shared_ptr<StreamPeerImpl>> writers;
  std::vector<std::shared_ptr<StreamPeerImpl>> readers;  ///< go on reading after that
};
Batch& CurrentBatch() {
  thread_local Batch batch;
  return batch;
}

class StreamPeerImpl final : public StreamPeer {
 public:
  StreamPeerImpl(asio::io_context& io, int read_fd, int write_fd, Framing framing,
                 Encoding encoding)
      : io_(io),
        read_fd_(read_fd),
        write_fd_(write_fd),
        encoding_(encoding),
        reader_(framing),
        buffer_(kReadBytes) {
    for (const int fd : {read_fd, write_fd}) {
      if (fd > STDERR_FILENO) continue;
      auto& stream = standard_[fd == read_fd ? 0 : 1];
      stream.fd = fd;
      stream.flags = fcntl(fd, F_GETFL);
    }
    if (CanWaitFor(read_fd_)) input_.emplace(io, read_fd_);
    if (write_fd_ != read_fd_ && CanWaitFor(write_fd_)) own_output_.emplace(io, write_fd_);
    if (auto* output = Output()) output->non_blocking(true);
  }

  ~StreamPeerImpl() override { CloseDescriptors(); }

  void Prefeed(std::string bytes) override { prefed_ = std::move(bytes); }

  void Start(OnLine on_line, OnClose on_close) override {
    on_line_ = std::move(on_line);
    on_close_ = std::move(on_close);
    asio::post(io_, [self = shared_from_this(), this] {
      const std::string first = std::exchange(prefed_, {});
      if (!first.empty() && !closed_) Take(first);
      ReadMore();
    });
  }

  void Send(std::string_view line) override {
    if (closed_ || output_dead_) return;
    if (encoding_.encoding() == Encoding::kUtf8) {
      outgoing_ += line;
    } else {
      outgoing_ += FromUtf8(line, encoding_.encoding());
    }
    outgoing_ += reader_.framing() == Framing::kMmi ? "./\n" : "\n";
    if (backlog_bytes() > kMaxBacklogBytes) {
      EndOutput("backlog over " + std::to_string(kMaxBacklogBytes) +
                " bytes: the reader is too slow");
      return;
    }
    ScheduleWrite();
  }

  void HoldInputWhileBehind() override { holds_while_behind_ = true; }

  void PauseReading() override { paused_ = true; }

  void ResumeReading() override {
    if (!paused_ || closed_) return;
    paused_ = false;
    GoOnReading();
  }

  void Flush(std::function<void()> done) override {
    if (closed_ || output_dead_ || (outgoing_.empty() && writing_.empty())) {
      asio::post(io_, std::move(done));
      return;
    }
    flushes_.push_back(std::move(done));
  }

  void Close() override {
    if (closed_) return;
    closed_ = true;
    CloseDescriptors();
    FinishFlushes();
    // Callbacks often own what holds us; let go of them once the present call is over.
    asio::post(io_, [self = shared_from_this(), this] {
      on_line_ = nullptr;
      on_close_ = nullptr;
    });
  }

  std::size_t backlog_bytes() const override {
    return outgoing_.size() + writing_.size() - written_;
  }

  /// Writes as much as the system takes at once; the rest follows when it takes more.
  void WriteMore() {
    if (closed_ || output_dead_) return;
    while (PrepareWriting()) {
      const auto rest = std::string_view(writing_).substr(written_);
      error_code error;
      std::size_t n = 0;
      if (auto* output = Output()) {
        n = output->write_some(asio::buffer(rest.data(), rest.size()), error);
        if (error == asio::error::would_block) return WriteWhenTaken(*output);
      } else {
        const ssize_t count = write(write_fd_, rest.data(), rest.size());
        if (count < 0) error.assign(errno, boost::system::system_category());
        n = count > 0 ? static_cast<std::size_t>(count) : 0;
      }
      if (error) return EndOutput("cannot write: " + error.message());
      written_ += n;
    }
    write_scheduled_ = false;
    FinishFlushes();
    if (holds_while_behind_ && (!held_.empty() || !reading_)) GoOnReading();
  }

  void ReadMore() {
    if (closed_ || paused_ || reading_ || input_ended_ || Behind()) return;
    reading_ = true;
    auto self = shared_from_this();
    if (input_) {
      input_->async_read_some(
          asio::buffer(buffer_), [self, this](const error_code& error, std::size_t n) {
            OnRead(n, error && error != asio::error::eof ? error.message() : std::string());
          });
      return;
    }
    asio::post(io_, [self, this] {
      const ssize_t n = closed_ ? 0 : read(read_fd_, buffer_.data(), buffer_.size());
      OnRead(n > 0 ? static_cast<std::size_t>(n) : 0, n < 0 ? std::strerror(errno) : "");
    });
  }

 private:
  bool Behind() const { return holds_while_behind_ && backlog_bytes() > kMaxBacklogBytes / 4; }

  void GoOnReading() {
    asio::post(io_, [self = shared_from_this(), this] {
      {
        const WriteBatch batch;
        DeliverHeld();
      }
      ReadMore();
    });
  }

  asio::posix::stream_descriptor* Output() {
    if (own_output_) return &*own_output_;
    return write_fd_ == read_fd_ && input_ ? &*input_ : nullptr;
  }

  void CloseDescriptors() {
    for (auto* descriptor : {&input_, &own_output_}) {
      if (!*descriptor) continue;
      error_code ignored;
      (*descriptor)->cancel(ignored);
      const int fd = (*descriptor)->release();
      descriptor->reset();
      if (fd > STDERR_FILENO) close(fd);
      if (fd == read_fd_) read_fd_ = write_fd_ == read_fd_ ? write_fd_ = -1 : -1;
      if (fd == write_fd_) write_fd_ = -1;
    }
    if (read_fd_ > STDERR_FILENO) close(read_fd_);
    if (write_fd_ > STDERR_FILENO && write_fd_ != read_fd_) close(write_fd_);
    read_fd_ = write_fd_ = -1;
  }

  void OnRead(std::size_t n, const std::string& error) {
    reading_ = false;
    if (closed_) return;
    const WriteBatch batch;
    HandleRead(n, error);
    // What was said because of this is written before there is another look for input.
    CurrentBatch().readers.push_back(std::static_pointer_cast<StreamPeerImpl>(shared_from_this()));
  }

  void HandleRead(std::size_t n, const std::string& error) {
    if (n > 0) {
      Take(std::string_view(buffer_.data(), n));
      return;
    }
    input_ended_ = true;
    end_ = {error.empty(), error.empty() ? "end of input" : "cannot read: " + error};
    // Only who ends in order means its last line without a newline as a whole one.
    if (error.empty())
      reader_.End([this](Result<std::string_view> line) { OnRawLine(std::move(line)); });
    DeliverHeld();
  }

  void Take(std::string_view bytes) {
    const auto self = shared_from_this();
    reader_.Feed(bytes, [this](Result<std::string_view> line) { OnRawLine(std::move(line)); });
  }

  void OnRawLine(Result<std::string_view> line) {
    if (closed_) return;
    if (paused_ || Behind() || !held_.empty()) {
      held_.push_back(line ? Result<std::string>(std::string(*line))
                           : std::unexpected(line.error()));
      return;
    }
    Deliver(line);
  }

  void Deliver(const Result<std::string_view>& line) {
    if (line && !encoding_.IsPlain(*line)) {
      const auto converted = encoding_.Read(*line);
      on_line_(converted ? Result<std::string_view>(*converted)
                         : std::unexpected(converted.error()));
    } else {
      on_line_(line);
    }
  }

  void DeliverHeld() {
    const auto self = shared_from_this();
    while (!held_.empty() && !paused_ && !closed_ && !Behind()) {
      // Taken out first, but the queue must not look empty to a nested OnRawLine: there is none,
      // since lines only arrive from the event loop.
      const Result<std::string> line = std::move(held_.front());
      held_.pop_front();
      Deliver(line ? Result<std::string_view>(*line) : std::unexpected(line.error()));
    }
    if (input_ended_ && held_.empty() && !paused_ && !closed_) ReportEnd(end_);
  }

  void ReportEnd(const StreamEnd& end) {
    if (end_reported_ || !on_close_) return;
    end_reported_ = true;
    const OnClose on_close = on_close_;
    on_close(end);
  }

  void ScheduleWrite() {
    if (write_scheduled_) return;
    write_scheduled_ = true;
    // Later, not at once: everything said within one batch goes out in one write.
    auto self = std::static_pointer_cast<StreamPeerImpl>(shared_from_this());
    if (CurrentBatch().open) {
      CurrentBatch().writers.push_back(std::move(self));
    } else {
      asio::post(io_, [self = std::move(self)] { self->WriteMore(); });
    }
  }

  /// Puts what was said since into writing_ once that is written; false if there is nothing.
  bool PrepareWriting() {
    if (written_ == writing_.size()) {
      writing_.clear();
      written_ = 0;
      writing_.swap(outgoing_);
    }
    return !writing_.empty();
  }

  void WriteWhenTaken(asio::posix::stream_descriptor& output) {
    output.async_wait(asio::posix::stream_descriptor::wait_write,
                      [self = shared_from_this(), this](const error_code& error) {
                        if (!error) WriteMore();
                      });
  }

  void EndOutput(const std::string& reason) {
    output_dead_ = true;
    outgoing_.clear();
    writing_.clear();
    written_ = 0;
    asio::post(io_, [self = shared_from_this(), this, reason] {
      FinishFlushes();
      if (!closed_) ReportEnd({false, reason});
    });
  }

  void FinishFlushes() {
    auto flushes = std::exchange(flushes_, {});
    for (auto& done : flushes) asio::post(io_, std::move(done));
  }

  asio::io_context& io_;
  std::array<StandardStream, 2> standard_;
  int read_fd_;
  int write_fd_;
  PeerEncoding encoding_;
  LineReader reader_;
  std::optional<asio::posix::stream_descriptor> input_;       // none: a file, read without waiting
  std::optional<asio::posix::stream_descriptor> own_output_;  // none: same as input_, or a file
  OnLine on_line_;
  OnClose on_close_;

  std::vector<char> buffer_;
  std::string prefed_;
  std::deque<Result<std::string>> held_;  // lines read while paused
  bool reading_ = false;
  bool paused_ = false;
  bool holds_while_behind_ = false;
  bool input_ended_ = false;
  bool end_reported_ = false;
  StreamEnd end_;

  std::string outgoing_;  // said, not yet being written
  std::string writing_;   // being written, from written_ on
  std::size_t written_ = 0;
  bool write_scheduled_ = false;
  bool output_dead_ = false;
  bool closed_ = false;
  std::vector<std::function<void()>> flushes_;
};

}  // namespace

WriteBatch::WriteBatch() : outermost_(!std::exchange(CurrentBatch().open, true)) {}

WriteBatch::~WriteBatch() {
  if (!outermost_) return;
  Batch& batch = CurrentBatch();
  batch.open = false;
  // By index: what ends in here may open a batch of its own, and the lists keep their room.
  for (std::size_t i = 0; i < batch.writers.size(); ++i) batch.writers[i]->WriteMore();
  batch.writers.clear();
  for (std::size_t i = 0; i < batch.readers.size(); ++i) batch.readers[i]->ReadMore();
  batch.readers.clear();
}

std::shared_ptr<StreamPeer> StreamPeer::Make(asio::io_context& io, int read_fd, int write_fd,
                                             Framing framing, Encoding encoding) {
  return std::make_shared<StreamPeerImpl>(io, read_fd, write_fd, framing, encoding);
}

}  // namespace vm
