/* A disk that fails: loaded in front of the C library, it makes the n-th operation below one folder fail, and writes down
 * what was done there. Must not know: what the files are for.
 *
 * SHIM_FOLDER   the folder that is watched, absolute and without links
 * SHIM_AT       which operation fails, counted from 1; none without it
 * SHIM_LASTING  whether those after it fail too
 * SHIM_ERROR    with which errno; 0: a write takes half of its bytes, and nothing else fails; -9: the run is killed
 * SHIM_LIES     only writes fail, and are said to have succeeded
 * SHIM_COUNT    a file that gets the number of operations, and what the failed one was
 * SHIM_TRACE    a file that gets every change, with its data
 * SHIM_NO_FLOCK flock is not supported
 * SHIM_HOST     a file that is read instead of /proc/sys/kernel/hostname
 * SHIM_BOOT     a file that is read instead of /proc/sys/kernel/random/boot_id
 * SHIM_THREAD   which thread cannot be started, counted from 1; with SHIM_LASTING all after it too
 * SHIM_MEMORY   which allocation fails, counted from the first look at a manifest; also written into SHIM_COUNT
 */
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#define MOST 1024
/* A call that is interrupted over and over is tried again over and over. */
#define INTERRUPTIONS 20

static int on, lies, lasting, error_number, no_flock, armed;
static long fail_at, count, memory_at, memory_count, next_id, thread_at, thread_count;
static const char *folder, *host, *boot;
static size_t folder_length;
static int count_file = -1, trace_file = -1;
static char failed_at[PATH_MAX + 64];
static struct { int open; long id; char path[512]; } files[MOST];
static pthread_mutex_t tracing = PTHREAD_MUTEX_INITIALIZER;

#define REAL(name) static __typeof__(name) *real; if (!real) real = (__typeof__(name) *)dlsym(RTLD_NEXT, #name)

static void put(int file, const void *bytes, size_t length)
{
    while (length > 0) {
        long written = syscall(SYS_write, file, bytes, length);
        if (written <= 0) return;
        bytes = (const char *)bytes + written, length -= (size_t)written;
    }
}

static const char *asked(const char *name)
{
    const char *value = getenv(name);
    return value && *value ? value : NULL;
}

static long number(const char *name) { return asked(name) ? atol(asked(name)) : 0; }

static int opened(const char *name)
{
    if (!asked(name)) return -1;
    int file = (int)syscall(SYS_openat, AT_FDCWD, asked(name), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    /* Out of the way of the numbers that the program gets. */
    int away = fcntl(file, F_DUPFD_CLOEXEC, 900);
    syscall(SYS_close, file);
    return away;
}

__attribute__((constructor)) static void begin(void)
{
    /* Programs that it starts are left alone. */
    if (strcmp(program_invocation_short_name, "gearstudy") != 0 || !asked("SHIM_FOLDER")) return;
    folder = asked("SHIM_FOLDER"), folder_length = strlen(folder);
    fail_at = number("SHIM_AT"), lasting = (int)number("SHIM_LASTING"), error_number = (int)number("SHIM_ERROR");
    lies = (int)number("SHIM_LIES"), memory_at = number("SHIM_MEMORY"), no_flock = (int)number("SHIM_NO_FLOCK");
    thread_at = number("SHIM_THREAD");
    host = asked("SHIM_HOST"), boot = asked("SHIM_BOOT");
    count_file = opened("SHIM_COUNT"), trace_file = opened("SHIM_TRACE");
    on = 1;
}

__attribute__((destructor)) static void end(void)
{
    char text[PATH_MAX + 128];
    if (!on || count_file < 0) return;
    int length = snprintf(text, sizeof text, "%ld %ld %s\n", count, memory_count, failed_at);
    put(count_file, text, (size_t)length);
}

/* The absolute path, if it is below the folder. */
static int below(int at, const char *path, char *whole)
{
    if (!on || !path) return 0;
    if (path[0] == '/') {
        snprintf(whole, PATH_MAX, "%s", path);
    } else if (at != AT_FDCWD) {
        if (at < 0 || at >= MOST || !files[at].open) return 0;
        snprintf(whole, PATH_MAX, "%s%s%s", files[at].path, *path ? "/" : "", path);
    } else {
        char here[PATH_MAX / 2];
        if (syscall(SYS_getcwd, here, sizeof here) < 0) return 0;
        snprintf(whole, PATH_MAX, "%s/%s", here, strncmp(path, "./", 2) ? path : path + 2);
    }
    return strncmp(whole, folder, folder_length) == 0 && (whole[folder_length] == '/' || !whole[folder_length]);
}

static int known(int file) { return on && file >= 0 && file < MOST && files[file].open; }

/* Counts an operation; whether it fails. */
static int fails(const char *what, const char *path)
{
    long now = __atomic_add_fetch(&count, 1, __ATOMIC_RELAXED);
    if (!fail_at || now < fail_at || error_number == 0 || (lies && strcmp(what, "write"))) return 0;
    if (now > fail_at && (!lasting || (error_number == EINTR && now > fail_at + INTERRUPTIONS))) return 0;
    if (error_number < 0) kill(getpid(), -error_number);
    if (now == fail_at) snprintf(failed_at, sizeof failed_at, "%s %s", what, path);
    errno = error_number;
    return 1;
}

static size_t shortened(const char *path, size_t length)
{
    int now = fail_at && error_number == 0 && (count == fail_at || (lasting && count > fail_at));
    if (now && count == fail_at) snprintf(failed_at, sizeof failed_at, "short write %s", path);
    return now && length > 1 ? length / 2 : length;
}

static void trace(const void *data, size_t length, const char *format, ...)
{
    if (trace_file < 0) return;
    char line[2 * PATH_MAX];
    va_list arguments;
    va_start(arguments, format);
    int size = vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    pthread_mutex_lock(&tracing);
    put(trace_file, line, (size_t)size);
    put(trace_file, data, length);
    pthread_mutex_unlock(&tracing);
}

static const char *inside(const char *path) { return path + folder_length + (path[folder_length] == '/'); }

static int remember(int file, const char *path, int flags)
{
    if (file >= 0 && file < MOST) {
        files[file].open = 1, files[file].id = __atomic_add_fetch(&next_id, 1, __ATOMIC_RELAXED);
        snprintf(files[file].path, sizeof files[file].path, "%s", path);
        trace(NULL, 0, "open\t%ld\t%s\t%d\n", files[file].id, inside(path), (flags & O_TRUNC) != 0);
    }
    return file;
}

static int open_any(int at, const char *path, int flags, mode_t mode)
{
    char whole[PATH_MAX];
    if (on && host && !strcmp(path, "/proc/sys/kernel/hostname")) path = host;
    if (on && boot && !strcmp(path, "/proc/sys/kernel/random/boot_id")) path = boot;
    int watched = below(at, path, whole);
    if (watched && memory_at && strstr(whole, "/manifest.json")) armed = 1;
    if (watched && fails("open", whole)) return -1;
    long file = syscall(SYS_openat, at, path, flags, mode);
    return watched ? remember((int)file, whole, flags) : (int)file;
}

#define OPEN(name) \
    int name(const char *path, int flags, ...) \
    { \
        va_list arguments; \
        va_start(arguments, flags); \
        mode_t mode = flags & O_CREAT ? va_arg(arguments, mode_t) : 0; \
        va_end(arguments); \
        return open_any(AT_FDCWD, path, flags, mode); \
    }
OPEN(open)
OPEN(open64)

#define OPENAT(name) \
    int name(int at, const char *path, int flags, ...) \
    { \
        va_list arguments; \
        va_start(arguments, flags); \
        mode_t mode = flags & O_CREAT ? va_arg(arguments, mode_t) : 0; \
        va_end(arguments); \
        return open_any(at, path, flags, mode); \
    }
OPENAT(openat)
OPENAT(openat64)

int creat(const char *path, mode_t mode) { return open_any(AT_FDCWD, path, O_CREAT | O_WRONLY | O_TRUNC, mode); }
int creat64(const char *path, mode_t mode) { return creat(path, mode); }

int close(int file)
{
    if (known(file)) files[file].open = 0;
    return (int)syscall(SYS_close, file);
}

ssize_t read(int file, void *bytes, size_t length)
{
    if (known(file) && fails("read", files[file].path)) return -1;
    return syscall(SYS_read, file, bytes, length);
}

static ssize_t read_at(int file, void *bytes, size_t length, off_t offset)
{
    if (known(file) && fails("read", files[file].path)) return -1;
    return syscall(SYS_pread64, file, bytes, length, offset);
}
ssize_t pread(int file, void *bytes, size_t length, off_t offset) { return read_at(file, bytes, length, offset); }
ssize_t pread64(int file, void *bytes, size_t length, off64_t offset) { return read_at(file, bytes, length, offset); }

/* At an offset, or, with -1, where the file stands. */
static ssize_t write_any(int file, const void *bytes, size_t length, off_t offset)
{
    int watched = known(file);
    if (watched && fails("write", files[file].path)) return lies ? (ssize_t)length : -1;
    if (watched) length = shortened(files[file].path, length);
    off_t at = offset >= 0 ? offset : (watched && trace_file >= 0 ? lseek(file, 0, SEEK_CUR) : 0);
    long written = offset >= 0 ? syscall(SYS_pwrite64, file, bytes, length, offset) : syscall(SYS_write, file, bytes, length);
    if (watched && written > 0) trace(bytes, (size_t)written, "write\t%ld\t%ld\t%ld\n", files[file].id, (long)at, written);
    return written;
}
ssize_t write(int file, const void *bytes, size_t length) { return write_any(file, bytes, length, -1); }
ssize_t pwrite(int file, const void *bytes, size_t length, off_t offset) { return write_any(file, bytes, length, offset); }
ssize_t pwrite64(int file, const void *bytes, size_t length, off64_t offset) { return write_any(file, bytes, length, offset); }

ssize_t writev(int file, const struct iovec *parts, int number_of_parts)
{
    /* A vector may be written in part. */
    if (known(file) && number_of_parts > 0) return write_any(file, parts[0].iov_base, parts[0].iov_len, -1);
    return syscall(SYS_writev, file, parts, number_of_parts);
}

static int sync_any(int file, long call)
{
    if (known(file) && fails("fsync", files[file].path)) return -1;
    if (known(file)) trace(NULL, 0, "fsync\t%ld\t%s\n", files[file].id, inside(files[file].path));
    /* The disk of a test need not spin. */
    return known(file) ? 0 : (int)syscall(call, file);
}
int fsync(int file) { return sync_any(file, SYS_fsync); }
int fdatasync(int file) { return sync_any(file, SYS_fdatasync); }

static int cut(int file, off_t length)
{
    if (known(file) && fails("truncate", files[file].path)) return -1;
    if (known(file)) trace(NULL, 0, "truncate\t%ld\t%ld\n", files[file].id, (long)length);
    return (int)syscall(SYS_ftruncate, file, length);
}
int ftruncate(int file, off_t length) { return cut(file, length); }
int ftruncate64(int file, off64_t length) { return cut(file, length); }

ssize_t copy_file_range(int from, off64_t *from_at, int to, off64_t *to_at, size_t length, unsigned flags)
{
    (void)from, (void)from_at, (void)to, (void)to_at, (void)length, (void)flags;
    /* Whoever copies falls back on reading and writing. */
    errno = ENOSYS;
    return -1;
}

static int move(const char *what, long call, const char *from, const char *to)
{
    char a[PATH_MAX], b[PATH_MAX];
    int watched = below(AT_FDCWD, from, a) & below(AT_FDCWD, to, b);
    if (watched && fails(what, b)) return -1;
    int result = (int)syscall(call, AT_FDCWD, from, AT_FDCWD, to, 0);
    if (watched && result == 0) trace(NULL, 0, "%s\t%s\t%s\n", what, inside(a), inside(b));
    return result;
}
int rename(const char *from, const char *to) { return move("rename", SYS_renameat2, from, to); }
int link(const char *from, const char *to) { return move("link", SYS_linkat, from, to); }
int linkat(int a, const char *from, int b, const char *to, int flags)
{
    if (a == AT_FDCWD && b == AT_FDCWD && flags == 0) return move("link", SYS_linkat, from, to);
    return (int)syscall(SYS_linkat, a, from, b, to, flags);
}

int mkdir(const char *path, mode_t mode)
{
    char whole[PATH_MAX];
    int watched = below(AT_FDCWD, path, whole);
    if (watched && fails("mkdir", whole)) return -1;
    int result = (int)syscall(SYS_mkdirat, AT_FDCWD, path, mode);
    if (watched && result == 0) trace(NULL, 0, "mkdir\t%s\n", inside(whole));
    return result;
}

static int take_away(int at, const char *path, int flags)
{
    char whole[PATH_MAX];
    int watched = below(at, path, whole);
    const char *what = flags & AT_REMOVEDIR ? "rmdir" : "unlink";
    if (watched && fails(what, whole)) return -1;
    int result = (int)syscall(SYS_unlinkat, at, path, flags);
    if (watched && result == 0) trace(NULL, 0, "%s\t%s\n", what, inside(whole));
    return result;
}
int unlink(const char *path) { return take_away(AT_FDCWD, path, 0); }
int rmdir(const char *path) { return take_away(AT_FDCWD, path, AT_REMOVEDIR); }
int unlinkat(int at, const char *path, int flags) { return take_away(at, path, flags); }

int statx(int at, const char *path, int flags, unsigned mask, struct statx *result)
{
    char whole[PATH_MAX];
    /* Rust asks without a path whether there is such a call, when the first one finds nothing; the header promises the
       compiler that nobody does. */
    const char *volatile given = path;
    int watched = !given ? 0 : *path ? below(at, path, whole) : known(at);
    if (watched && fails("stat", *path ? whole : files[at].path)) return -1;
    return (int)syscall(SYS_statx, at, path, flags, mask, result);
}

static int stat_any(int at, const char *path, struct stat *result, int flags)
{
    char whole[PATH_MAX];
    int watched = *path ? below(at, path, whole) : known(at);
    if (watched && fails("stat", *path ? whole : files[at].path)) return -1;
    return (int)syscall(SYS_newfstatat, at, path, result, flags);
}
int stat(const char *path, struct stat *result) { return stat_any(AT_FDCWD, path, result, 0); }
int stat64(const char *path, struct stat64 *result) { return stat_any(AT_FDCWD, path, (struct stat *)result, 0); }
int lstat(const char *path, struct stat *result) { return stat_any(AT_FDCWD, path, result, AT_SYMLINK_NOFOLLOW); }
int lstat64(const char *path, struct stat64 *result)
{
    return stat_any(AT_FDCWD, path, (struct stat *)result, AT_SYMLINK_NOFOLLOW);
}
int fstat(int file, struct stat *result) { return stat_any(file, "", result, AT_EMPTY_PATH); }
int fstat64(int file, struct stat64 *result) { return stat_any(file, "", (struct stat *)result, AT_EMPTY_PATH); }
int fstatat(int at, const char *path, struct stat *result, int flags) { return stat_any(at, path, result, flags); }
int fstatat64(int at, const char *path, struct stat64 *result, int flags)
{
    return stat_any(at, path, (struct stat *)result, flags);
}

DIR *opendir(const char *path)
{
    char whole[PATH_MAX];
    REAL(opendir);
    int watched = below(AT_FDCWD, path, whole);
    if (watched && fails("opendir", whole)) return NULL;
    DIR *list = real(path);
    if (watched && list) remember(dirfd(list), whole, 0);
    return list;
}

struct dirent64 *readdir64(DIR *list)
{
    REAL(readdir64);
    int file = dirfd(list);
    return known(file) && fails("readdir", files[file].path) ? NULL : real(list);
}

int closedir(DIR *list)
{
    REAL(closedir);
    if (known(dirfd(list))) files[dirfd(list)].open = 0;
    return real(list);
}

int flock(int file, int operation)
{
    if (known(file) && no_flock) {
        errno = EOPNOTSUPP;
        return -1;
    }
    if (known(file) && fails("flock", files[file].path)) return -1;
    return (int)syscall(SYS_flock, file, operation);
}

extern void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t);

static int no_memory(void)
{
    if (!armed || __atomic_add_fetch(&memory_count, 1, __ATOMIC_RELAXED) != memory_at) return 0;
    errno = ENOMEM;
    return 1;
}
void *malloc(size_t size) { return no_memory() ? NULL : __libc_malloc(size); }
void *calloc(size_t number_of, size_t size) { return no_memory() ? NULL : __libc_calloc(number_of, size); }
void *realloc(void *old, size_t size) { return no_memory() ? NULL : __libc_realloc(old, size); }

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*begin_at)(void *), void *given)
{
    REAL(pthread_create);
    if (on && thread_at) {
        long now = __atomic_add_fetch(&thread_count, 1, __ATOMIC_RELAXED);
        if (now == thread_at || (lasting && now > thread_at)) return EAGAIN;
    }
    return real(thread, attributes, begin_at, given);
}
