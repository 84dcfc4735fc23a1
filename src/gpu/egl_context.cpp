// Contexts without a surface: EGL's device platform, then Mesa's surfaceless platform. Displays are never terminated,
// because EGL hands the same one to everybody in the process, the host included, and terminating it ends their
// contexts.
#include <dlfcn.h>

#include <string_view>
#include <utility>

#include <epoxy/egl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "gpu/context.h"
#include "gpu/gl.h"

namespace brickfield {

namespace {

constexpr const char* kSubject = "OpenGL 4.5 context";

bool hasExtension(const char* list, std::string_view name) {
  for (std::string_view rest = list ? list : ""; !rest.empty();) {
    const std::size_t end = rest.find(' ');
    if (rest.substr(0, end) == name) return true;
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  return false;
}

std::string eglErrorText() {
  const EGLint code = eglGetError();
  switch (code) {
  case EGL_SUCCESS:
    return "no reason given";
  case EGL_NOT_INITIALIZED:
    return "EGL_NOT_INITIALIZED";
  case EGL_BAD_ACCESS:
    return "EGL_BAD_ACCESS";
  case EGL_BAD_ALLOC:
    return "EGL_BAD_ALLOC";
  case EGL_BAD_ATTRIBUTE:
    return "EGL_BAD_ATTRIBUTE";
  case EGL_BAD_CONFIG:
    return "EGL_BAD_CONFIG";
  case EGL_BAD_DISPLAY:
    return "EGL_BAD_DISPLAY";
  case EGL_BAD_MATCH:
    return "EGL_BAD_MATCH";
  case EGL_BAD_PARAMETER:
    return "EGL_BAD_PARAMETER";
  default:
    return fmt::format("EGL error {:#x}", static_cast<unsigned>(code));
  }
}

// epoxy ends the process where a library is missing, so this comes before all else.
void requireLibraries() {
  for (const char* name : {"libEGL.so.1", "libGL.so.1"}) {
    void* library = ::dlopen(name, RTLD_LAZY | RTLD_LOCAL);
    if (!library) throw BadInput(kSubject, "", fmt::format("the library {} is missing", name));
    ::dlclose(library);
  }
}

// What is current in this thread, put back at the end of the scope unless kept.
class CurrentContextScope {
public:
  CurrentContextScope()
      : display_(eglGetCurrentDisplay()),
        draw_(eglGetCurrentSurface(EGL_DRAW)),
        read_(eglGetCurrentSurface(EGL_READ)),
        context_(eglGetCurrentContext()),
        api_(eglQueryAPI()) {}
  ~CurrentContextScope() {
    if (api_ != EGL_NONE) eglBindAPI(api_);
    if (!keepNew_ && context_ != EGL_NO_CONTEXT) eglMakeCurrent(display_, draw_, read_, context_);
  }
  CurrentContextScope(const CurrentContextScope&) = delete;
  CurrentContextScope& operator=(const CurrentContextScope&) = delete;
  void keepNew() { keepNew_ = true; }

private:
  EGLDisplay display_;
  EGLSurface draw_;
  EGLSurface read_;
  EGLContext context_;
  EGLenum api_;
  bool keepNew_ = false;
};

class SurfacelessContext final : public Context {
public:
  SurfacelessContext(EGLDisplay display, EGLContext context, std::string platform, bool debug, bool softwareDevice)
      : display_(display), context_(context) {
    try {
      makeCurrent();
      adopt(std::move(platform), debug, softwareDevice);
    } catch (...) {
      destroy();
      throw;
    }
  }
  ~SurfacelessContext() override { destroy(); }

  void makeCurrent() override {
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
      throw Failure(fmt::format("EGL context cannot be made current: {}", eglErrorText()));
  }
  void release() override {
    if (eglGetCurrentContext() == context_) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }

private:
  void destroy() {
    release();
    eglDestroyContext(display_, context_);
  }

  EGLDisplay display_;
  EGLContext context_;
};

// EGL's functions beyond 1.4, asked for by name: the library's own eglGetPlatformDisplay (core 1.5) needs a display
// that is already initialised when it is called through epoxy.
struct EglEntryPoints {
  PFNEGLGETPLATFORMDISPLAYEXTPROC getPlatformDisplay = nullptr;
  PFNEGLQUERYDEVICESEXTPROC queryDevices = nullptr;
  PFNEGLQUERYDEVICESTRINGEXTPROC queryDeviceString = nullptr;
  bool surfacelessPlatform = false;
  std::string why; // no devices can be listed, or no display made

  EglEntryPoints() {
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!client) {
      why = fmt::format("EGL has no client extensions (is a driver installed? {})", eglErrorText());
      return;
    }
    if (hasExtension(client, "EGL_EXT_platform_base")) load(getPlatformDisplay, "eglGetPlatformDisplayEXT");
    if (!getPlatformDisplay) {
      why = "EGL lacks EGL_EXT_platform_base (is a driver installed?)";
      return;
    }
    surfacelessPlatform = hasExtension(client, "EGL_MESA_platform_surfaceless");
    const bool canList =
        hasExtension(client, "EGL_EXT_device_base") ||
        (hasExtension(client, "EGL_EXT_device_enumeration") && hasExtension(client, "EGL_EXT_device_query"));
    if (canList && hasExtension(client, "EGL_EXT_platform_device")) {
      load(queryDevices, "eglQueryDevicesEXT");
      load(queryDeviceString, "eglQueryDeviceStringEXT");
    }
    if (!queryDevices) why = "EGL cannot list devices";
  }

  template <typename Function>
  static void load(Function& function, const char* name) {
    function = reinterpret_cast<Function>(eglGetProcAddress(name));
  }

  std::vector<EGLDeviceEXT> devices() const {
    EGLint count = 0;
    if (!queryDevices || !queryDevices(0, nullptr, &count)) return {};
    std::vector<EGLDeviceEXT> found(static_cast<std::size_t>(count));
    if (!queryDevices(count, found.data(), &count)) return {};
    found.resize(static_cast<std::size_t>(count));
    return found;
  }

  bool isSoftware(EGLDeviceEXT device) const {
    return queryDeviceString && hasExtension(queryDeviceString(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
  }
};

std::string deviceName(std::size_t index) { return fmt::format("EGL device {}", index); }

[[noreturn]] void refuse(const std::string& platform, const std::string& reason) {
  throw BadInput(kSubject, platform, reason);
}

// error BadInput "SUBJECT: PLATFORM: reason"
std::unique_ptr<Context> createOnDisplay(EGLDisplay display, const std::string& platform, bool debug, bool software) {
  if (display == EGL_NO_DISPLAY) refuse(platform, fmt::format("no display ({})", eglErrorText()));
  EGLint major = 0, minor = 0;
  if (!eglInitialize(display, &major, &minor)) refuse(platform, fmt::format("not initialised ({})", eglErrorText()));
  const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
  const bool core15 = major > 1 || minor >= 5;
  if (!core15 && !hasExtension(extensions, "EGL_KHR_create_context")) refuse(platform, "lacks EGL_KHR_create_context");
  if (!hasExtension(extensions, "EGL_KHR_surfaceless_context")) refuse(platform, "lacks EGL_KHR_surfaceless_context");
  if (!eglBindAPI(EGL_OPENGL_API)) refuse(platform, "has no desktop OpenGL");

  EGLConfig config = EGL_NO_CONFIG_KHR;
  if (!hasExtension(extensions, "EGL_KHR_no_config_context")) {
    const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLint count = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &count) || count == 0)
      refuse(platform, "has no config for OpenGL");
  }
  std::vector<EGLint> attributes = {EGL_CONTEXT_MAJOR_VERSION,       4,
                                    EGL_CONTEXT_MINOR_VERSION,       5,
                                    EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
  if (debug && core15) attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE});
  if (debug && !core15) attributes.insert(attributes.end(), {EGL_CONTEXT_FLAGS_KHR, EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR});
  attributes.push_back(EGL_NONE);
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
  if (context == EGL_NO_CONTEXT) refuse(platform, fmt::format("no OpenGL 4.5 core context ({})", eglErrorText()));
  return std::make_unique<SurfacelessContext>(display, context, platform, debug, software);
}

std::unique_ptr<Context> createOnDevice(const EglEntryPoints& egl, EGLDeviceEXT device, std::size_t index, bool debug) {
  const EGLDisplay display = egl.getPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
  return createOnDisplay(display, deviceName(index), debug, egl.isSoftware(device));
}

// The message of one attempt without the subject that the final message has once.
std::string reasonOf(const Error& error) {
  std::string text = error.what();
  const std::string prefix = fmt::format("{}: ", kSubject);
  return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
}

// Attempts in order of preference; the reasons of those that failed add up to the final message.
class Search {
public:
  template <typename Create>
  void attempt(const Create& create) {
    if (found_ && !found_->info().isSoftware) return;
    if (found_) found_->release();
    try {
      std::unique_ptr<Context> context = create();
      if (!found_ || !context->info().isSoftware) found_ = std::move(context);
    } catch (const Error& error) {
      reasons_.push_back(reasonOf(error));
    }
  }
  void note(std::string reason) { reasons_.push_back(std::move(reason)); }
  bool hasFound() const { return found_ != nullptr; }

  std::unique_ptr<Context> take() {
    if (!found_) throw BadInput(kSubject, "", fmt::format("{}", fmt::join(reasons_, "; ")));
    found_->makeCurrent();
    return std::move(found_);
  }

private:
  std::unique_ptr<Context> found_;
  std::vector<std::string> reasons_;
};

// Software devices are tried only where no other gave a context: making one on llvmpipe takes a while.
std::unique_ptr<Context> createAnywhere(const EglEntryPoints& egl, bool debug) {
  Search search;
  if (!egl.why.empty()) search.note(egl.why);
  const std::vector<EGLDeviceEXT> devices = egl.devices();
  if (egl.why.empty() && devices.empty()) search.note("EGL lists no devices");
  for (const bool software : {false, true}) {
    if (software && search.hasFound()) break;
    for (std::size_t i = 0; i < devices.size(); ++i)
      if (egl.isSoftware(devices[i]) == software && !(software && search.hasFound()))
        search.attempt([&] { return createOnDevice(egl, devices[i], i, debug); });
  }
  if (!search.hasFound() && egl.surfacelessPlatform)
    search.attempt([&] {
      const EGLDisplay display = egl.getPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
      return createOnDisplay(display, "EGL surfaceless", debug, false);
    });
  else if (!egl.surfacelessPlatform)
    search.note("EGL surfaceless: not offered");
  return search.take();
}

} // namespace

std::unique_ptr<Context> Context::createHeadless(int device, bool debug) {
  requireLibraries();
  CurrentContextScope previous;
  const EglEntryPoints egl;
  std::unique_ptr<Context> context;
  if (device < 0) {
    context = createAnywhere(egl, debug);
  } else {
    const std::vector<EGLDeviceEXT> devices = egl.devices();
    const auto index = static_cast<std::size_t>(device);
    if (!egl.why.empty()) refuse(deviceName(index), egl.why);
    if (index >= devices.size())
      refuse(deviceName(index), fmt::format("no such device; {} are there, counted from 0", devices.size()));
    context = createOnDevice(egl, devices[index], index, debug);
  }
  previous.keepNew();
  return context;
}

std::vector<DeviceInfo> listDevices() {
  requireLibraries();
  const CurrentContextScope previous;
  const EglEntryPoints egl;
  const std::vector<EGLDeviceEXT> devices = egl.devices();
  std::vector<DeviceInfo> infos(devices.size());
  for (std::size_t i = 0; i < devices.size(); ++i) {
    infos[i].index = static_cast<int>(i);
    infos[i].context.platform = deviceName(i);
    try {
      infos[i].context = createOnDevice(egl, devices[i], i, false)->info();
    } catch (const Error& error) {
      infos[i].error = reasonOf(error);
    }
  }
  return infos;
}

} // namespace brickfield
