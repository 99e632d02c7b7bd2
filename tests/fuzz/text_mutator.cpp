// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/text_mutator.h"

#include <algorithm>
#include <cctype>

namespace helio::fuzz {

namespace {

using Tokens = std::vector<std::string_view>;

constexpr std::string_view kNumbers[] = {"0",
                                         "-0",
                                         "1",
                                         "-1",
                                         "2",
                                         "3",
                                         "0.5",
                                         "1e-9",
                                         "-1e-9",
                                         "1e-4",
                                         "0.0001",
                                         "1e9",
                                         "-1e9",
                                         "1e308",
                                         "-1e308",
                                         "1e309",
                                         "1e-320",
                                         "2147483647",
                                         "180",
                                         "-90",
                                         "360",
                                         "90",
                                         "2147483648",
                                         "4294967295",
                                         "-2147483649",
                                         "9007199254740993",
                                         "18446744073709551615",
                                         "1e5",
                                         "100000",
                                         "1e7",
                                         "0.001",
                                         "99999999999999999999",
                                         "0x10",
                                         "1.",
                                         ".5",
                                         "1e",
                                         "00",
                                         "1000",
                                         "0.1"};
constexpr std::string_view kBrackets = "()[]{}";
constexpr std::string_view kBytes = "\0\x01\n\r\t\"'\\/*|:;,.=<>%~#@$&!?-+\x7f\x80\xc3\xff";

bool isName(char c)
{
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool isSpace(char c)
{
    return c == ' ' || c == '\n' || c == '\t' || c == '\r';
}
bool isNumber(std::string_view token)
{
    return !token.empty() && std::isdigit(static_cast<unsigned char>(token[0])) != 0;
}
bool isWord(std::string_view token)
{
    return !token.empty() && isName(token[0]) && !isNumber(token);
}
bool isQuoted(std::string_view token)
{
    return token.size() > 1 && token[0] == '"';
}

class Mutator
{
public:
    Mutator(std::string_view text, std::string_view other, std::span<const std::string_view> words, Random& random)
        : text_(text), other_(other), words_(words), random_(random)
    {
    }

    std::string run(size_t largest)
    {
        for (size_t step = 0, count = below(2) == 0 ? 1 : 1 + below(6); step < count; ++step) {
            change();
            if (text_.size() > largest) text_.resize(largest);
        }
        return std::move(text_);
    }

private:
    size_t below(size_t n) { return size_t(random_.next() % std::max<size_t>(n, 1)); }
    template <class List> auto pick(const List& list) { return list[below(std::size(list))]; }

    void replace(size_t at, size_t gone, std::string_view with) { text_.replace(at, gone, std::string(with)); }
    void replace(std::string_view token, std::string_view with)
    {
        replace(size_t(token.data() - text_.data()), token.size(), with);
    }

    // A token of the text for which `test` holds, if a few tries find one.
    template <class Test> std::string_view find(const Tokens& tokens, const Test& test)
    {
        for (u32 tries = 0; tries < 64 && !tokens.empty(); ++tries)
            if (const std::string_view token = pick(tokens); test(token)) return token;
        return {};
    }

    // From a bracket to its partner, or to the end of the text.
    static std::string_view blockAt(std::string_view text, size_t at)
    {
        size_t depth = 0, end = at;
        for (; end < text.size(); ++end) {
            const size_t kind = kBrackets.find(text[end]);
            if (kind == std::string_view::npos) continue;
            if (kind % 2 == 0)
                ++depth;
            else if (depth > 0 && --depth == 0)
                return text.substr(at, end + 1 - at);
        }
        return text.substr(at, end - at);
    }
    std::string_view pickBlock(std::string_view text)
    {
        for (u32 tries = 0; tries < 32 && !text.empty(); ++tries) {
            const size_t at = text.find_first_of("([{", below(text.size()));
            if (at != std::string_view::npos) return blockAt(text, at);
        }
        return {};
    }
    std::string_view pickLines(std::string_view text)
    {
        size_t begin = below(text.size());
        while (begin > 0 && text[begin - 1] != '\n') --begin;
        size_t end = begin;
        for (size_t lines = 1 + below(6); lines > 0 && end < text.size(); --lines)
            end = std::min(text.find('\n', end), text.size() - 1) + 1;
        return text.substr(begin, end - begin);
    }
    std::string_view pickPiece(std::string_view text) { return below(2) == 0 ? pickBlock(text) : pickLines(text); }

    void change()
    {
        switch (below(14)) {
        case 0:
        case 1:
            return changeNumber();
        case 2:
            return swapTokens();
        case 3:
        case 4:
            return replaceWord();
        case 5:
            return insertWord();
        case 6:
            return repeatPiece();
        case 7:
            return dropPiece();
        case 8:
            return changeBracket();
        case 9:
            return splice();
        case 10:
            return moveBlock();
        case 11:
            if (below(4) == 0) text_.resize(below(text_.size() + 1));
            return;
        case 12:
            return changeQuoted();
        default:
            return changeByte();
        }
    }

    void changeNumber()
    {
        const Tokens tokens = tokensOf(text_);
        const std::string_view number = find(tokens, isNumber);
        if (number.empty()) return;
        const std::string_view twin = find(tokens, isNumber);
        const std::string with(below(3) == 0 ? twin : pick(kNumbers));
        replace(number, with);
    }
    void swapTokens()
    {
        const Tokens tokens = tokensOf(text_);
        if (tokens.size() < 2) return;
        const auto isSolid = [](std::string_view token) { return !isSpace(token[0]); };
        std::string_view a = find(tokens, isSolid), b = find(tokens, isSolid);
        if (a.empty() || b.empty() || a.data() == b.data()) return;
        if (a.data() > b.data()) std::swap(a, b);
        const std::string first(a), second(b);
        const size_t at = size_t(a.data() - text_.data());
        replace(b, first); // the later one, so that the other stays where it is
        replace(at, first.size(), second);
    }
    void replaceWord()
    {
        const Tokens tokens = tokensOf(text_);
        const std::string_view word = find(tokens, isWord);
        if (word.empty()) return;
        const std::string with(below(2) == 0 || words_.empty() ? find(tokens, isWord) : pick(words_));
        replace(word, with);
    }
    void insertWord()
    {
        const Tokens tokens = tokensOf(text_);
        if (tokens.empty() || words_.empty()) return;
        const size_t at = size_t(pick(tokens).data() - text_.data());
        replace(at, 0, concat(" ", pick(words_), " "));
    }
    void repeatPiece()
    {
        const std::string_view piece = pickPiece(text_);
        if (piece.empty()) return;
        const std::string_view between = below(4) == 0 ? "" : ",";
        std::string copies;
        // Rarely very many: depth and length are limited somewhere.
        for (size_t n = below(16) == 0 ? 1 + below(200) : 1 + below(3); n > 0 && copies.size() < 100000; --n)
            copies += std::string(piece) + std::string(between);
        replace(size_t(piece.data() - text_.data()), 0, copies);
    }
    void dropPiece()
    {
        const std::string_view piece = pickPiece(text_);
        if (piece.empty()) return;
        // With the comma behind it, so that a list stays a list.
        const size_t at = size_t(piece.data() - text_.data()), end = at + piece.size();
        replace(at, piece.size() + (end < text_.size() && text_[end] == ',' ? 1 : 0), "");
    }
    void changeBracket()
    {
        const size_t at = text_.find_first_of(kBrackets, below(text_.size()));
        if (at == std::string::npos) return;
        const char bracket = kBrackets[below(kBrackets.size())];
        switch (below(8)) {
        case 0:
            return replace(at, 0, std::string(below(16) == 0 ? 1 + below(5000) : 1 + below(120), bracket));
        case 1:
        case 2:
            return replace(at, 1, "");
        case 3:
        case 4:
            return replace(at, 0, std::string(1, bracket));
        default:
            return replace(at, 1, std::string(1, bracket));
        }
    }
    void splice()
    {
        if (other_.empty()) return;
        if (below(4) == 0) return replace(below(text_.size() + 1), text_.size(), other_.substr(below(other_.size())));
        const std::string_view piece = pickPiece(other_), old = pickPiece(text_);
        if (old.empty()) return;
        replace(size_t(old.data() - text_.data()), below(2) == 0 ? old.size() : 0, piece);
    }
    void moveBlock()
    {
        const std::string block(pickBlock(text_));
        const std::string_view old = pickBlock(text_);
        if (!old.empty()) replace(old, block);
    }
    void changeQuoted()
    {
        const Tokens tokens = tokensOf(text_);
        const std::string_view quoted = find(tokens, isQuoted);
        if (quoted.empty()) return;
        const std::string with =
            below(2) == 0 || words_.empty() ? std::string(find(tokens, isQuoted)) : concat('"', pick(words_), '"');
        replace(quoted, with);
    }
    void changeByte()
    {
        if (text_.empty()) return;
        const char byte = below(4) == 0 ? char(random_.next() & 0xff) : kBytes[below(kBytes.size())];
        replace(below(text_.size()), below(2), std::string(1, byte));
    }

    std::string text_;
    std::string_view other_;
    std::span<const std::string_view> words_;
    Random& random_;
};

} // namespace

std::vector<std::string_view> tokensOf(std::string_view text)
{
    std::vector<std::string_view> tokens;
    for (size_t begin = 0, end; begin < text.size(); begin = end) {
        end = begin + 1;
        const char c = text[begin];
        if (std::isdigit(static_cast<unsigned char>(c))) {
            while (end < text.size() && (isName(text[end]) || text[end] == '.')) ++end;
        } else if (isName(c)) {
            while (end < text.size() && isName(text[end])) ++end;
        } else if (isSpace(c)) {
            while (end < text.size() && isSpace(text[end])) ++end;
        } else if (c == '"') {
            while (end < text.size() && text[end] != '"' && text[end] != '\n') ++end;
            end = std::min(end + 1, text.size());
        }
        tokens.push_back(text.substr(begin, end - begin));
    }
    return tokens;
}

std::string mutateText(std::string_view text, std::string_view other, std::span<const std::string_view> words,
                       size_t largest, Random& random)
{
    return Mutator(text, other, words, random).run(largest);
}

} // namespace helio::fuzz
