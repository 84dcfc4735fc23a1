// Squares of two by two pixels, of which one was marched at half resolution, as entries of a list of work: which of
// their pixels are to be marched, too, a bit each, the upper row after the lower.
uint entryOfSquare(ivec2 square, uint pixels) { return uint(square.y) << 18 | uint(square.x) << 4 | pixels; }
ivec2 squareOfEntry(uint entry) { return ivec2(entry >> 4 & 0x3fffu, entry >> 18); }
ivec2 pixelOfSquare(ivec2 square, int number) { return 2 * square + ivec2(number & 1, number >> 1); }
bool isMarched(uint entry, int number) { return (entry >> uint(number) & 1u) != 0u; }
