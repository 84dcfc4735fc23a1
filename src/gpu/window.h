// The window behind a context: events, size and swapping, enough for a viewer. Main thread only (GLFW's rule).
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include <glm/glm.hpp>

namespace brickfield {

/// Keys are their upper-case ASCII character ('A', '1', ' '), or one of these.
enum class Key : int {
  Escape = 256,
  Enter,
  Tab,
  Backspace,
  Right = 262,
  Left,
  Down,
  Up,
  F1 = 290,
  F2,
  F3,
  F4,
  F5,
  F6,
  F7,
  F8,
  F9,
  F10,
  F11,
  F12,
  LeftShift = 340,
  LeftControl,
  LeftAlt
};

enum class MouseButton : int { Left = 0, Right = 1, Middle = 2 };

/// What happened; members may be left empty. Called from inside Window::poll. Positions are in framebuffer pixels,
/// origin at the top left. An exception that a callback throws leaves poll().
struct WindowEvents {
  std::function<void(int key, bool pressed, bool repeated)> onKey;
  std::function<void(MouseButton button, bool pressed, glm::vec2 position)> onMouseButton;
  std::function<void(glm::vec2 position)> onMouseMove;
  std::function<void(glm::vec2 steps)> onScroll;
  std::function<void(const std::vector<std::filesystem::path>& files)> onDrop;
};

class Window {
public:
  virtual ~Window() = default;

  virtual void setEvents(WindowEvents events) = 0;
  /// Handles pending events, calling what setEvents was given.
  virtual void poll() = 0;
  virtual void swap() = 0;
  virtual bool shouldClose() const = 0;
  virtual void requestClose() = 0;
  /// Pixels of the default framebuffer; (0,0) while minimized.
  virtual glm::ivec2 framebufferSize() const = 0;
  virtual bool isKeyDown(int key) const = 0;
  bool isKeyDown(Key key) const { return isKeyDown(static_cast<int>(key)); }
  virtual bool isMouseDown(MouseButton button) const = 0;
  /// Framebuffer pixels from the top left.
  virtual glm::vec2 mousePosition() const = 0;
  /// Hides the pointer and lets it move without bounds, for flying.
  virtual void capturePointer(bool captured) = 0;
  virtual void setTitle(const char* title) = 0;
};

} // namespace brickfield
