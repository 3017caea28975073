#include "denoise/oidn.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <utility>

namespace montelux {

namespace {

// The library's own types and numbers, as its manual has them.
struct Device;
struct Filter;
constexpr int cpu_device = 1, float3_format = 3, no_error = 0, cancelled = 6;
constexpr int max_memory_mb = 2048;  // it then works in tiles

// Its functions. Version 2 has other names for some.
struct Functions {
  Device* (*new_device)(int type);
  void (*set_device_bool)(Device*, const char* name, bool);
  void (*set_device_int)(Device*, const char* name, int);
  int (*get_device_int)(Device*, const char* name);
  void (*commit_device)(Device*);
  int (*get_device_error)(Device*, const char** message);
  void (*release_device)(Device*);
  Filter* (*new_filter)(Device*, const char* type);
  void (*set_image)(Filter*, const char* name, void* data, int format, std::size_t width, std::size_t height,
                    std::size_t byte_offset, std::size_t pixel_stride, std::size_t row_stride);
  void (*set_filter_bool)(Filter*, const char* name, bool);
  void (*set_filter_int)(Filter*, const char* name, int);
  void (*set_progress_monitor)(Filter*, bool (*monitor)(void* user, double done), void* user);
  void (*commit_filter)(Filter*);
  void (*execute_filter)(Filter*);
  void (*release_filter)(Filter*);
};

// The first function of these names; the first name, if there is none.
template <class Function>
std::optional<std::string> find(void* library, std::initializer_list<const char*> names, Function& function) {
  for (const char* name : names)
    if (void* symbol = dlsym(library, name)) {
      function = reinterpret_cast<Function>(symbol);
      return std::nullopt;
    }
  return *names.begin();
}

Result<Functions> functions_of(void* library) {
  Functions f{};
  for (const std::optional<std::string>& missing :
       {find(library, {"oidnNewDevice"}, f.new_device),
        find(library, {"oidnSetDeviceBool", "oidnSetDevice1b"}, f.set_device_bool),
        find(library, {"oidnSetDeviceInt", "oidnSetDevice1i"}, f.set_device_int),
        find(library, {"oidnGetDeviceInt", "oidnGetDevice1i"}, f.get_device_int),
        find(library, {"oidnCommitDevice"}, f.commit_device), find(library, {"oidnGetDeviceError"}, f.get_device_error),
        find(library, {"oidnReleaseDevice"}, f.release_device), find(library, {"oidnNewFilter"}, f.new_filter),
        find(library, {"oidnSetSharedFilterImage"}, f.set_image),
        find(library, {"oidnSetFilterBool", "oidnSetFilter1b"}, f.set_filter_bool),
        find(library, {"oidnSetFilterInt", "oidnSetFilter1i"}, f.set_filter_int),
        find(library, {"oidnSetFilterProgressMonitorFunction"}, f.set_progress_monitor),
        find(library, {"oidnCommitFilter"}, f.commit_filter), find(library, {"oidnExecuteFilter"}, f.execute_filter),
        find(library, {"oidnReleaseFilter"}, f.release_filter)})
    if (missing) return Failure{fmt::format("it has no function {}", *missing)};
  return f;
}

class Oidn final : public ColorFilter {
 public:
  explicit Oidn(const Functions& functions) : f_(functions), version_(version_of_device()) {}

  std::string name() const override { return "oidn " + version_; }

  std::vector<float> filter(const FilterInput& input, int threads, const std::function<bool()>& stop) const override {
    const DeviceOwner device = new_device(threads);
    const FilterOwner filter(f_.new_filter(device.get(), "RT"), f_.release_filter);
    check(device.get());
    std::vector<float> output(input.color.size());
    const auto set = [&](const char* name, const std::vector<float>& values) {
      // It reads all images but the output, which it writes.
      f_.set_image(filter.get(), name, const_cast<float*>(values.data()), float3_format, std::size_t(input.width),
                   std::size_t(input.height), 0, 0, 0);
    };
    set("color", input.color), set("albedo", input.albedo), set("normal", input.normal), set("output", output);
    f_.set_filter_bool(filter.get(), "hdr", true);
    f_.set_filter_int(filter.get(), "maxMemoryMB", max_memory_mb);
    const std::function<bool()>* stops = stop ? &stop : nullptr;
    if (stops) f_.set_progress_monitor(filter.get(), &continues, const_cast<std::function<bool()>*>(stops));
    f_.commit_filter(filter.get());
    check(device.get());
    f_.execute_filter(filter.get());
    check(device.get());
    if (stop && stop()) throw std::runtime_error("stopped");
    return output;
  }

 private:
  using DeviceOwner = std::unique_ptr<Device, void (*)(Device*)>;
  using FilterOwner = std::unique_ptr<Filter, void (*)(Filter*)>;

  static bool continues(void* stops, double) { return !(*static_cast<const std::function<bool()>*>(stops))(); }

  DeviceOwner new_device(int threads) const {
    DeviceOwner device(f_.new_device(cpu_device), f_.release_device);
    check(device.get());
    if (!device) throw std::runtime_error("Open Image Denoise has no device for this processor");
    if (threads > 0) f_.set_device_int(device.get(), "numThreads", threads);
    f_.set_device_bool(device.get(), "setAffinity", false);  // other threads of the program run beside it
    f_.commit_device(device.get());
    check(device.get());
    return device;
  }

  void check(Device* device) const {
    const char* message = nullptr;
    const int code = f_.get_device_error(device, &message);
    if (code == no_error) return;
    if (code == cancelled) throw std::runtime_error("stopped");
    throw std::runtime_error(fmt::format("Open Image Denoise: {}", message ? message : "unknown error"));
  }

  std::string version_of_device() const {
    const DeviceOwner device = new_device(1);
    std::array<int, 3> numbers{};
    std::size_t i = 0;
    for (const char* part : {"versionMajor", "versionMinor", "versionPatch"})
      numbers[i++] = f_.get_device_int(device.get(), part);
    check(device.get());
    return fmt::format("{}", fmt::join(numbers, "."));
  }

  Functions f_;
  std::string version_;
};

std::vector<std::string> system_files() {
  std::vector<std::string> files;
  for (const char* version : {".2", ".1", ".0", ""}) files.push_back(fmt::format("libOpenImageDenoise.so{}", version));
  return files;
}

// The library of this file, and null with a message if it cannot be loaded.
std::pair<void*, std::string> open_library(const std::string& file) {
  if (void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) return {library, {}};
  const char* error = dlerror();
  return {nullptr, error ? error : "unknown error"};
}

Result<std::shared_ptr<const ColorFilter>> filter_of(void* library, const std::string& file) {
  const Result<Functions> functions = functions_of(library);
  if (!functions) return Failure{fmt::format("'{}' is not Open Image Denoise: {}", file, functions.error())};
  try {
    return std::shared_ptr<const ColorFilter>(std::make_shared<Oidn>(*functions));
  } catch (const std::exception& e) {
    return Failure{fmt::format("'{}' does not work here: {}", file, e.what())};
  }
}

}  // namespace

Result<std::shared_ptr<const ColorFilter>> load_oidn(const std::string& file) {
  if (!file.empty()) {
    const auto [library, error] = open_library(file);
    if (!library) return Failure{fmt::format("Open Image Denoise cannot be loaded: {}", error)};
    return filter_of(library, file);
  }
  std::string others;
  const std::vector<std::string> names = system_files();
  for (const std::string& name : names) {
    const auto [library, error] = open_library(name);
    if (library) return filter_of(library, name);
    // Anything but a missing file is worth a word.
    if (!error.starts_with(name)) others += "; " + error;
  }
  return Failure{
      fmt::format("Open Image Denoise is not installed: there is no {}{}; its file may be stated by oidn:library=FILE",
                  fmt::join(names, ", "), others)};
}

}  // namespace montelux
