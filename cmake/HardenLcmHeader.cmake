# lcm-gen's decoders trust the counts in a message: a corrupt one would allocate gigabytes, a negative string
# length would be undefined behaviour. Every element of an array takes room in the buffer, so no count may
# exceed what is left of it divided by an element's smallest size (for a struct, that of an empty one; a row of a
# matrix has at least one number); every string has at least its terminator. Decoding then allocates no more than
# a few times the size of the message. Fails if the header allocates in a form that is not known here.
file(READ ${HEADER} text)

set(guarded_resize "(this->[A-Za-z0-9_]+(\\[a0\\])?)\\.resize\\((this->[A-Za-z0-9_]+)\\);")
string(REGEX REPLACE "${guarded_resize}"
  "if (\\3 < 0 || \\3 > (maxlen - pos) / planbench_smallest_size(\\1)) return -1; \\1.RESIZE(\\3);"
  text "${text}")
set(string_length "if\\((__[A-Za-z0-9_]+) > maxlen - pos\\) return -1;")
string(REGEX REPLACE "${string_length}" "if (\\1 < 1 || \\1 > maxlen - pos) return -1;" text "${text}")

foreach(unguarded "\\.resize\\(" "\\.reserve\\(" "new ")
  if(text MATCHES "${unguarded}")
    message(FATAL_ERROR "${HEADER}: this lcm-gen allocates in a form that cmake/HardenLcmHeader.cmake does not know")
  endif()
endforeach()
string(REGEX MATCHALL "\\.assign\\(" assignments "${text}")
string(REGEX MATCHALL "if \\(__[A-Za-z0-9_]+ < 1 " length_checks "${text}")
list(LENGTH assignments num_assignments)
list(LENGTH length_checks num_length_checks)
if(NOT num_assignments EQUAL num_length_checks)
  message(FATAL_ERROR "${HEADER}: this lcm-gen reads text in a form that cmake/HardenLcmHeader.cmake does not know")
endif()
string(REPLACE ".RESIZE(" ".resize(" text "${text}")

set(helper [[
#ifndef PLANBENCH_SMALLEST_SIZE
#define PLANBENCH_SMALLEST_SIZE
#include <string>
#include <type_traits>
#include <vector>
// Bytes that an element of a list takes in a message at least.
template <typename Element>
struct planbench_element {
    static int smallest_size() {
        if constexpr (std::is_arithmetic_v<Element>) return sizeof(Element);
        else return Element()._getEncodedSizeNoHash();
    }
};
template <>
struct planbench_element<std::string> {
    static int smallest_size() { return 5; }  // length and terminator
};
template <typename Number>
struct planbench_element<std::vector<Number>> {
    static int smallest_size() { return sizeof(Number); }
};
template <typename Element>
int planbench_smallest_size(const std::vector<Element>&) {
    return planbench_element<Element>::smallest_size();
}
#endif
]])
file(WRITE ${HEADER} "${helper}${text}")
