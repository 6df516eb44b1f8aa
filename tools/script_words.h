#pragma once

// A line of a script as words, and the reading of a command's arguments off them.

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "dowel/assembly/project.h"
#include "dowel/kernel/error.h"

namespace dowel::tools {

/// Bad input at a place of a command line.
class CommandError : public Error {
 public:
  /// `column`: from 1, in bytes.
  CommandError(ErrorCode code, const std::string& message, std::size_t column)
      : Error(code, message), column_(column) {}

  std::size_t column() const noexcept { return column_; }

 private:
  std::size_t column_;
};

struct Word {
  std::string text;
  std::size_t column = 1;  ///< where it starts, from 1, in bytes
  bool quoted = false;     ///< then it is a name, never a keyword
};

/// Words stand between blanks. "..." and '...' hold blanks; in "..." a backslash takes the next
/// character as it is. A '#' where a word could start begins a comment. Throws CommandError for a
/// quote that is not closed.
std::vector<Word> split_words(std::string_view line);

/// The words as a line that splits into them again.
std::string join_words(const std::vector<Word>& words);

/// The words behind a command, read from left to right. What is not as expected is a CommandError
/// at the word in question.
class Arguments {
 public:
  /// `words`: the command's own word first.
  explicit Arguments(std::vector<Word> words) : words_(std::move(words)) {}

  const std::vector<Word>& words() const { return words_; }
  /// The whole command as the journal keeps it.
  std::string line() const { return join_words(words_); }

  bool at_end() const { return next_ == words_.size(); }
  /// Takes the next word where it is `keyword`.
  bool take(std::string_view keyword);
  void expect(std::string_view keyword);
  /// True where the next word reads as a number.
  bool is_number() const;

  /// `what` says in errors what is expected: "an instance", "an angle in degrees".
  std::string word(std::string_view what);
  double number(std::string_view what);
  std::size_t count(std::string_view what);
  Eigen::Vector3d point(std::string_view what);
  /// INSTANCE.FEATURE
  FeatureName feature(std::string_view what);
  void expect_end() const;

  /// Runs `use` on what the last word said; an Error of it is one at that word.
  template <class Use>
  auto located(Use&& use) const {
    try {
      return use();
    } catch (const CommandError&) {
      throw;
    } catch (const Error& error) {
      throw CommandError(error.code(), error.what(), last_column());
    }
  }

  /// An error at the next word, or behind the last one.
  [[noreturn]] void fail(const std::string& message) const;
  /// An error at the word that was read last.
  [[noreturn]] void fail_at_last(const std::string& message) const;

 private:
  std::size_t last_column() const;

  std::vector<Word> words_;
  std::size_t next_ = 1;
};

}  // namespace dowel::tools
