/* Stands for what QOCO's own build writes: its code for an operating system with a clock, which
 * no_clock.c replaces. */
#ifndef QOCO_CONFIG_H
#define QOCO_CONFIG_H
#define IS_LINUX
#define QOCO_VERSION_MAJOR 0 /* printed only, and nothing is */
#define QOCO_VERSION_MINOR 0
#define QOCO_VERSION_PATCH 0
#endif
