// The prompt on a terminal, on libedit.

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>

#include <histedit.h>

#include "commands.h"
#include "script.h"
#include "table.h"

namespace dowel::tools {
namespace {

constexpr int kHistoryLength = 1000;

struct EndEditLine {
  void operator()(EditLine* line) const { el_end(line); }
};
struct EndHistory {
  void operator()(History* history) const { history_end(history); }
};

char* prompt_text(EditLine*) {
  // The library asks for a pointer that it does not write to.
  static char text[] = "dowel> ";
  return text;
}

Console& console_of(EditLine* line) {
  void* console = nullptr;
  el_get(line, EL_CLIENTDATA, &console);
  return *static_cast<Console*>(console);
}

std::string common_start(const std::vector<std::string>& words) {
  std::string common = words.front();
  for (const std::string& word : words) {
    const auto end = std::mismatch(common.begin(), common.end(), word.begin(), word.end()).first;
    common.erase(end, common.end());
  }
  return common;
}

/// Bound to the tab key: completes the word before the cursor, or shows what it may become.
unsigned char complete(EditLine* line, int) {
  const LineInfo* info = el_line(line);
  const std::string_view typed(info->buffer, static_cast<std::size_t>(info->cursor - info->buffer));
  std::vector<Word> before;
  try {
    before = split_words(typed);
  } catch (const CommandError&) {
    return CC_ERROR;  // inside a quote
  }
  std::string start;
  if (!typed.empty() && typed.back() != ' ' && typed.back() != '\t' && !before.empty()) {
    start = before.back().text;
    before.pop_back();
  }
  std::vector<std::string> words;
  try {
    words = console_of(line).completions(before, start);
  } catch (const Error&) {
    return CC_ERROR;  // a damaged file is told when a command meets it
  }
  if (words.empty()) return CC_ERROR;
  std::string more = common_start(words).substr(start.size());
  if (words.size() == 1) more += ' ';
  if (!more.empty()) return el_insertstr(line, more.c_str()) == 0 ? CC_REFRESH : CC_ERROR;
  std::printf("\n");
  for (const std::string& word : words) std::printf("%s  ", printable(word).c_str());
  std::printf("\n");
  return CC_REDISPLAY;
}

/// Bound to Ctrl-C: drops the line and begins a new one.
unsigned char drop_line(EditLine* line, int) {
  const LineInfoW* const info = el_wline(line);
  const auto length = static_cast<int>(info->lastchar - info->buffer);
  el_cursor(line, static_cast<int>(info->lastchar - info->cursor));
  el_deletestr(line, length);
  std::printf("^C\n");
  return CC_REDISPLAY;
}

void run_at_prompt(Console& console, std::string_view line, bool& quits) {
  try {
    const std::vector<Word> words = split_words(line);
    if (words.empty()) return;
    const Reply reply = console.run(words);
    quits = reply.quits;
    print_reply(reply, words.front().text, 0, 0.0, {});
    std::fflush(stdout);
  } catch (const CommandError& error) {
    std::fflush(stdout);
    std::fprintf(stderr, "%zu: error: %s\n", error.column(), printable(error.what()).c_str());
  }
}

}  // namespace

int run_prompt(Console& console) {
  const std::unique_ptr<EditLine, EndEditLine> line(el_init("dowel", stdin, stdout, stderr));
  const std::unique_ptr<History, EndHistory> memory(history_init());
  if (line == nullptr || memory == nullptr) {
    throw Error(ErrorCode::FileUnreadable, "the terminal cannot be read");
  }
  HistEvent event;
  history(memory.get(), &event, H_SETSIZE, kHistoryLength);
  history(memory.get(), &event, H_SETUNIQUE, 1);
  el_set(line.get(), EL_CLIENTDATA, &console);
  el_set(line.get(), EL_PROMPT, &prompt_text);
  el_set(line.get(), EL_SIGNAL, 1);
  el_set(line.get(), EL_EDITOR, "emacs");
  el_set(line.get(), EL_HIST, history, memory.get());
  el_set(line.get(), EL_ADDFN, "dowel-complete", "Completes a name", &complete);
  el_set(line.get(), EL_BIND, "^I", "dowel-complete", nullptr);
  // While a line is edited Ctrl-C is a key; while a command runs it ends the program as ever, and
  // the project is as it was before that command.
  el_set(line.get(), EL_SETTY, "-d", "-isig", nullptr);
  el_set(line.get(), EL_ADDFN, "dowel-drop-line", "Drops the line", &drop_line);
  el_set(line.get(), EL_BIND, "^C", "dowel-drop-line", nullptr);
  el_set(line.get(), EL_BIND, "^R", "em-inc-search-prev", nullptr);

  const auto& file = console.session().project().file();
  std::printf("dowel: %s; `help` lists the commands\n",
              file.empty() ? "project in memory, `save FILE` keeps it" : file.c_str());
  bool quits = false;
  while (!quits) {
    int length = 0;
    const char* const typed = el_gets(line.get(), &length);
    if (typed == nullptr || length <= 0) break;
    std::string_view text(typed, static_cast<std::size_t>(length));
    while (text.ends_with('\n') || text.ends_with('\r')) text.remove_suffix(1);
    if (!text.empty()) history(memory.get(), &event, H_ENTER, typed);
    run_at_prompt(console, text, quits);
  }
  if (!quits) std::printf("\n");
  return kDone;
}

}  // namespace dowel::tools
