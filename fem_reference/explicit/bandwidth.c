/* Part of kernel.c: what memory delivers, for the measurements of cost and speed. */

/* The STREAM triad a = b + s c, repeated: what the memory that n numbers fit into delivers. */
void triad(double *restrict a, const double *restrict b, const double *restrict c, int64_t n,
           int64_t repetitions) {
    for (int64_t k = 0; k < repetitions; ++k) {
        for (int64_t i = 0; i < n; ++i) a[i] = b[i] + 0.5 * c[i];
        __asm__ volatile("" : : "r"(a) : "memory"); /* every repetition counts */
    }
}

/* The sum of n numbers: what so many threads read from where they lie. */
double read_all(const double *a, int64_t n, int64_t threads) {
    double sum = 0.0;
#pragma omp parallel for simd reduction(+ : sum) num_threads(threads)
    for (int64_t i = 0; i < n; ++i) sum += a[i];
    return sum;
}
