#pragma once

#include <string>
#include <string_view>

#include "fsm/render/gl_functions.h"

namespace fsm {

/// A linked shader program. Destroy while its context is current.
class GlProgram {
 public:
  /// Throws std::runtime_error with the compiler's words if a source is wrong; `name` is for them.
  GlProgram(const GlFunctions& gl, const char* name, std::string_view vertex,
            std::string_view fragment);
  ~GlProgram() { gl_.DeleteProgram(id_); }
  GlProgram(const GlProgram&) = delete;
  GlProgram& operator=(const GlProgram&) = delete;

  GLuint id() const { return id_; }
  /// -1, which GL ignores, for a uniform the program does not use.
  GLint Uniform(const char* name) const { return gl_.GetUniformLocation(id_, name); }

 private:
  const GlFunctions& gl_;
  GLuint id_;
};

/// Where a frame is drawn and where it is read from: colour with 4 samples and depth, and the plain
/// picture they are resolved into. Destroy while its context is current.
class GlTarget {
 public:
  GlTarget(const GlFunctions& gl, int width, int height);
  ~GlTarget();
  GlTarget(const GlTarget&) = delete;
  GlTarget& operator=(const GlTarget&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  /// Makes the many-sampled picture the one drawn into.
  void Bind() const;
  /// Averages the samples into the plain picture.
  void Resolve() const;
  /// The framebuffer object of the plain picture.
  GLuint resolved() const { return frames_[1]; }

 private:
  const GlFunctions& gl_;
  int width_;
  int height_;
  GLuint frames_[2] = {};   // many-sampled, resolved
  GLuint buffers_[3] = {};  // colour and depth of the first, colour of the second
};

}  // namespace fsm
