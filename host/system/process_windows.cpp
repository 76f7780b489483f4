#include <fcntl.h>
#include <io.h>
#include <windows.h>
// After windows.h.
#include <shellapi.h>

#include <cstdio>
#include <cstdlib>

#include "host/system/process.hpp"
#include "host/system/wide.hpp"

namespace flaunay::system {
namespace {

void (*clean_up_now)() = nullptr;

// The next handler, which is the system's, ends the process.
BOOL WINAPI clean_up_and_pass_on(DWORD) {
  clean_up_now();
  return FALSE;
}

HANDLE terminal() { return GetStdHandle(STD_ERROR_HANDLE); }

}  // namespace

void prepare_streams() {
  for (std::FILE* const stream : {stdin, stdout, stderr}) {
    if (_fileno(stream) >= 0) _setmode(_fileno(stream), _O_BINARY);
  }
  // A console shows bytes by its code page, which outlasts the program.
  static const UINT code_page_before = GetConsoleOutputCP();
  if (code_page_before == 0 || code_page_before == CP_UTF8 || SetConsoleOutputCP(CP_UTF8) == FALSE) return;
  std::atexit([] { SetConsoleOutputCP(code_page_before); });
}

// To write to it is an error there.
void end_on_closed_pipe() {}

std::vector<std::string> arguments_of_main(int, char**) {
  int count = 0;
  wchar_t** const texts = CommandLineToArgvW(GetCommandLineW(), &count);
  std::vector<std::string> arguments;
  for (int k = 0; k < count; ++k) arguments.push_back(narrow(texts[k]));
  LocalFree(texts);
  return arguments;
}

void clean_up_when_interrupted(void (*clean_up)()) {
  clean_up_now = clean_up;
  SetConsoleCtrlHandler(clean_up_and_pass_on, TRUE);
}

std::size_t terminal_width() {
  DWORD mode = 0;
  CONSOLE_SCREEN_BUFFER_INFO about{};
  if (GetConsoleMode(terminal(), &mode) == FALSE ||
      SetConsoleMode(terminal(), mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING) == FALSE ||
      GetConsoleScreenBufferInfo(terminal(), &about) == FALSE) {
    return 0;
  }
  return static_cast<std::size_t>(about.srWindow.Right - about.srWindow.Left + 1);
}

void write_to_terminal(const std::string& text) {
  DWORD written = 0;
  WriteFile(terminal(), text.data(), static_cast<DWORD>(text.size()), &written, nullptr);
}

}  // namespace flaunay::system
