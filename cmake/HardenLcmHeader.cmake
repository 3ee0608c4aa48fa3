# lcm-gen's decoders trust the counts in a message: a corrupt one would allocate gigabytes, a negative string
# length would be undefined behaviour. Every element of an array takes room in the buffer, so no count may
# exceed what is left of it; every string has at least its terminator.
file(READ ${HEADER} text)
string(REGEX REPLACE
  "(this->[A-Za-z0-9_]+(\\[a0\\])?\\.resize\\((this->num_[A-Za-z0-9_]+)\\);)"
  "if (\\3 < 0 || \\3 > maxlen - pos) return -1; \\1" text "${text}")
string(REGEX REPLACE "if\\((__[A-Za-z0-9_]+) > maxlen - pos\\) return -1;"
  "if (\\1 < 1 || \\1 > maxlen - pos) return -1;" text "${text}")
file(WRITE ${HEADER} "${text}")
