#include "core/config/yaml/yaml_syntax.h"

#include <optional>
#include <string_view>
#include <vector>

#include "core/base/printable.h"
#include "core/config/yaml/yaml_limits.h"

namespace dmise {
namespace {

YAML::Mark mark_of(int line, std::size_t column) {
  YAML::Mark mark;
  mark.pos = mark.line = line;
  mark.column = int(column);
  return mark;
}

struct SyntaxFault {
  YAML::Mark mark;
  std::string reason;
};

/// Finds brackets and quotes that are not closed, and tabs in indentations.
class SyntaxScan {
 public:
  explicit SyntaxScan(std::string_view text) {
    for (int line = 0; !text.empty() && !fault_; ++line) {
      const std::size_t end = text.find('\n');
      scan(text.substr(0, end), line);
      text = end == text.npos ? std::string_view() : text.substr(end + 1);
    }
    if (fault_) return;
    if (quote_)
      fault_ = {quote_at_, std::string("the quote ") + quote_ + " is not closed"};
    else if (!open_.empty())
      fault_ = {open_.back().mark,
                std::string("the bracket ") + open_.back().bracket + " is not closed"};
  }

  const std::optional<SyntaxFault>& fault() const { return fault_; }

 private:
  struct Open {
    char bracket;
    YAML::Mark mark;
  };

  void scan(std::string_view text, int line) {
    const std::size_t indent = std::min(text.find_first_not_of(" \t"), text.size());
    if (block_indent_) {  // a text over several lines, in which brackets mean nothing
      if (indent == text.size() || indent > *block_indent_) return;
      block_indent_.reset();
    }
    if (!quote_ && open_.empty() && indent < text.size() && text[indent] != '#')
      if (const std::size_t tab = text.find('\t'); tab < indent) {
        fault_ = {mark_of(line, tab), "a tab in the indentation, which must be of spaces"};
        return;
      }
    bool begins = true;  // whether a value may begin here
    for (std::size_t k = 0; k < text.size() && !fault_; ++k) {
      const char c = text[k];
      if (quote_) {
        if (c == '\\' && quote_ == '"')
          ++k;
        else if (c == quote_ && quote_ == '\'' && text.substr(k + 1).starts_with('\''))
          ++k;
        else if (c == quote_)
          quote_ = 0;
        continue;
      }
      const bool after_space = k == 0 || text[k - 1] == ' ' || text[k - 1] == '\t';
      if (c == '#' && after_space) break;
      if (c == ' ' || c == '\t' || c == '\r') continue;
      if (begins && (c == '"' || c == '\'')) {
        quote_ = c;
        quote_at_ = mark_of(line, k);
      } else if ((c == '{' || c == '[') && (begins || !open_.empty())) {
        open_.push_back({c, mark_of(line, k)});
      } else if ((c == '}' || c == ']') && !open_.empty()) {
        close(c, mark_of(line, k));
      } else if ((c == '|' || c == '>') && begins && open_.empty()) {
        block_indent_ = indent;
        return;
      }
      const bool before_space = k + 1 == text.size() || text[k + 1] == ' ';
      begins = c == '{' || c == '[' || (c == ',' && !open_.empty()) ||
               ((c == ':' || c == '-') && before_space);
    }
  }

  void close(char bracket, const YAML::Mark& mark) {
    const Open open = open_.back();
    open_.pop_back();
    if ((open.bracket == '{') == (bracket == '}')) return;
    fault_ = {open.mark, std::string("the bracket ") + open.bracket + " is closed by " + bracket +
                             " in line " + std::to_string(mark.line + 1)};
  }

  std::vector<Open> open_;
  char quote_ = 0;
  YAML::Mark quote_at_;
  std::optional<std::size_t> block_indent_;
  std::optional<SyntaxFault> fault_;
};

/// What a message of the parser asks for in words of the file.
std::string_view hint_of(std::string_view message) {
  if (message.starts_with("end of map") || message.starts_with("end of sequence"))
    return " (is this line indented as those before it?)";
  if (message.starts_with("illegal map value"))
    return " (a second ': ' in a line, or a line that is indented too far?)";
  return "";
}

}  // namespace

std::string syntax_complaint(const std::string& text, const std::string& file,
                             const YAML::Exception& refusal) {
  const SyntaxScan scan(text);
  const std::string words = ": not valid YAML: ";
  if (scan.fault()) return place_of(file, scan.fault()->mark) + words + scan.fault()->reason;
  return place_of(file, refusal.mark) + words + printable(refusal.msg) +
         std::string(hint_of(refusal.msg));
}

}  // namespace dmise
