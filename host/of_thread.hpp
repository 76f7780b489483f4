// Objects that each thread has for itself.
#pragma once

namespace flaunay::host {

/// The calling thread's own object, made when it is first asked for and destroyed with the thread. Exit
/// handlers and destructors of static objects run after that, on the main thread; they get another object,
/// which stays.
template <typename T>
T& of_thread() {
  static thread_local T* object = nullptr;
  static thread_local const struct End {
    ~End() {
      delete object;
      object = nullptr;
    }
  } end;
  if (object == nullptr) object = new T();
  return *object;
}

}  // namespace flaunay::host
