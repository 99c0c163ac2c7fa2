#version 430
// Averages the samples of each pixel exactly as samples.cc does, into RGBA8 bytes, the picture's upper row first. One
// invocation computes one pixel.
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) writeonly buffer Pixels { uint pixels[]; };
uniform sampler2D samples;  // lowest row first
uniform bool soft;          // average over 4 x 4 samples with less weight on the outer ones

ivec4 At(ivec2 at) {
  at = clamp(at, ivec2(0), textureSize(samples, 0) - 1);
  return ivec4(texelFetch(samples, at, 0) * 255.0 + 0.5);
}
int Weight(int k) { return k == 0 || k == 1 ? 3 : 1; }

void main() {
  ivec2 size = textureSize(samples, 0) / 2;
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  ivec2 first = 2 * ivec2(pixel.x, size.y - 1 - pixel.y);
  int beside = soft ? 1 : 0;
  ivec4 sum = ivec4(0);
  for (int y = -beside; y < 2 + beside; ++y) {
    for (int x = -beside; x < 2 + beside; ++x) sum += Weight(x) * Weight(y) * At(first + ivec2(x, y));
  }
  int whole = soft ? 64 : 36;
  uvec4 average = uvec4((sum + whole / 2) / whole);
  pixels[pixel.y * size.x + pixel.x] =
      average.r | average.g << 8 | average.b << 16 | average.a << 24;
}
