#pragma once

// Explicit instantiation of function templates for both precisions.

// Preprocessors rescan a list as often as they are told to: 27 names at most.
#define WEFT_PARENTHESES ()
#define WEFT_RESCAN(...) WEFT_RESCAN_1(WEFT_RESCAN_1(WEFT_RESCAN_1(__VA_ARGS__)))
#define WEFT_RESCAN_1(...) WEFT_RESCAN_2(WEFT_RESCAN_2(WEFT_RESCAN_2(__VA_ARGS__)))
#define WEFT_RESCAN_2(...) WEFT_RESCAN_3(WEFT_RESCAN_3(WEFT_RESCAN_3(__VA_ARGS__)))
#define WEFT_RESCAN_3(...) __VA_ARGS__
#define WEFT_INSTANTIATE_NEXT() WEFT_INSTANTIATE_FIRST
#define WEFT_INSTANTIATE_FIRST(name, ...)       \
  template decltype(name<float>) name<float>;   \
  template decltype(name<double>) name<double>; \
  __VA_OPT__(WEFT_INSTANTIATE_NEXT WEFT_PARENTHESES(__VA_ARGS__))

/// Instantiates the function templates that are named, for float and double.
#define WEFT_INSTANTIATE_FUNCTIONS(...) WEFT_RESCAN(WEFT_INSTANTIATE_FIRST(__VA_ARGS__))
