/* The conversation with the comparison: after a line "ready DESCRIPTION", each number on a line of standard input is a
 * batch of so many repetitions, answered with the CPU time of this process and the time on the wall that it took, in
 * seconds; "check" is answered with some values of the result. */
#ifndef BATCHES_H
#define BATCHES_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double seconds(clockid_t clock)
{
    struct timespec time;
    clock_gettime(clock, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static int serve(const char *description, void (*once)(void), void (*check)(void))
{
    char line[64];
    printf("ready %s\n", description);
    fflush(stdout);
    while (fgets(line, sizeof line, stdin)) {
        if (strcmp(line, "check\n") == 0) {
            once();
            check();
        } else {
            const long repetitions = strtol(line, NULL, 10);
            const double cpu = seconds(CLOCK_PROCESS_CPUTIME_ID), wall = seconds(CLOCK_MONOTONIC);
            for (long i = 0; i < repetitions; i++)
                once();
            printf("%.9e %.9e\n", seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu, seconds(CLOCK_MONOTONIC) - wall);
        }
        fflush(stdout);
    }
    return 0;
}

#endif
