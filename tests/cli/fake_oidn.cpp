// A library with the interface of Open Image Denoise, as its manual has it: a plain filter, to test how such a library
// is loaded and called. OLD_NAMES: with the names of version 1. FAKE_OIDN_ERROR in the environment makes it fail.
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

#ifdef OLD_NAMES
#define NAME_OF(what, old_type, type) oidn##what##old_type
constexpr int version[3] = {1, 4, 3};
#else
#define NAME_OF(what, old_type, type) oidn##what##type
constexpr int version[3] = {2, 8, 9};
#endif

namespace {

struct Device {
  bool committed = false;
  int error = 0;
  std::string message;
  void fail(int code, const std::string& text) {
    if (error == 0) error = code, message = text;
  }
};

struct Image {
  float* data;
  std::size_t width, height;
};

struct Filter {
  Device* device;
  std::map<std::string, Image> images;
  bool hdr = false, committed = false;
  bool (*monitor)(void*, double) = nullptr;
  void* user = nullptr;
};

float square_distance(const float* a, const float* b) {
  float sum = 0;
  for (int c = 0; c < 3; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

// Averages over 5 x 5 pixels whose features, and roughly whose colours, are alike.
void filter_pixel(const Filter& f, std::size_t x, std::size_t y) {
  const Image &color = f.images.at("color"), &albedo = f.images.at("albedo"), &normal = f.images.at("normal");
  const std::size_t at = y * color.width + x;
  float sum[3] = {}, weights = 0;
  for (std::size_t v = y < 2 ? 0 : y - 2; v <= y + 2 && v < color.height; ++v)
    for (std::size_t u = x < 2 ? 0 : x - 2; u <= x + 2 && u < color.width; ++u) {
      const std::size_t other = v * color.width + u;
      const float features = square_distance(albedo.data + 3 * at, albedo.data + 3 * other) +
                             square_distance(normal.data + 3 * at, normal.data + 3 * other);
      const float colors = square_distance(color.data + 3 * at, color.data + 3 * other);
      const float weight = std::exp(-100 * features) / (1 + colors);
      weights += weight;
      for (int c = 0; c < 3; ++c) sum[c] += weight * color.data[3 * other + std::size_t(c)];
    }
  for (int c = 0; c < 3; ++c) f.images.at("output").data[3 * at + std::size_t(c)] = sum[c] / weights;
}

void execute(Filter& f) {
  if (!f.committed || !f.device->committed) return f.device->fail(3, "not committed");
  if (const char* text = std::getenv("FAKE_OIDN_ERROR")) return f.device->fail(4, text);
  const Image& output = f.images.at("output");
  for (std::size_t y = 0; y < output.height; ++y) {
    if (f.monitor && !f.monitor(f.user, double(y) / double(output.height))) return f.device->fail(6, "cancelled");
    for (std::size_t x = 0; x < output.width; ++x) filter_pixel(f, x, y);
  }
}

}  // namespace

extern "C" {

Device* oidnNewDevice(int type) {
  if (type != 1) return nullptr;
  return new Device;
}
void NAME_OF(SetDevice, 1b, Bool)(Device* device, const char* name, bool) {
  if (std::strcmp(name, "setAffinity") != 0) device->fail(2, "unknown parameter");
}
void NAME_OF(SetDevice, 1i, Int)(Device* device, const char* name, int value) {
  if (std::strcmp(name, "numThreads") != 0 || value < 1) device->fail(2, "unknown parameter");
}
int NAME_OF(GetDevice, 1i, Int)(Device*, const char* name) {
  int part = 0;
  for (const char* known : {"versionMajor", "versionMinor", "versionPatch"}) {
    if (std::strcmp(name, known) == 0) return version[part];
    ++part;
  }
  return 0;
}
void oidnCommitDevice(Device* device) { device->committed = true; }
int oidnGetDeviceError(Device* device, const char** message) {
  static std::string text;
  if (!device) return 0;
  const int code = device->error;
  device->error = 0, text = device->message;
  if (message) *message = text.c_str();
  return code;
}
void oidnReleaseDevice(Device* device) { delete device; }

Filter* oidnNewFilter(Device* device, const char* type) {
  if (std::strcmp(type, "RT") != 0) device->fail(2, "unknown filter");
  return new Filter{device, {}};
}
void oidnSetSharedFilterImage(Filter* f, const char* name, void* data, int format, std::size_t width,
                              std::size_t height, std::size_t offset, std::size_t pixel, std::size_t row) {
  if (format != 3 || offset != 0 || pixel != 0 || row != 0) return f->device->fail(2, "unsupported image");
  f->images[name] = {static_cast<float*>(data), width, height};
}
void NAME_OF(SetFilter, 1b, Bool)(Filter* f, const char* name, bool value) {
  if (std::strcmp(name, "hdr") == 0) f->hdr = value;
}
void NAME_OF(SetFilter, 1i, Int)(Filter*, const char*, int) {}
void oidnSetFilterProgressMonitorFunction(Filter* f, bool (*monitor)(void*, double), void* user) {
  f->monitor = monitor, f->user = user;
}
void oidnCommitFilter(Filter* f) {
  for (const char* name : {"color", "albedo", "normal", "output"})
    if (!f->images.contains(name)) return f->device->fail(3, std::string("no image ") + name);
  if (!f->hdr) return f->device->fail(3, "not of high dynamic range");
  f->committed = true;
}
void oidnExecuteFilter(Filter* f) { execute(*f); }
void oidnReleaseFilter(Filter* f) { delete f; }
}
