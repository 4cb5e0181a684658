// SPDX-License-Identifier: Apache-2.0
// wasi.js: WASI (preview 1) for the commands, over node's synchronous file functions. Nothing can be reached but the
// standard streams and the folders that it is given; links cannot be made, so that none leads out of them.
//
// Paths are bytes on POSIX systems; here each is a string of one character per byte (latin1).

import fs from 'node:fs';
import path from 'node:path';
import tty from 'node:tty';

const kErrors = {
  E2BIG: 1, EACCES: 2, EAGAIN: 6, EBADF: 8, EBUSY: 10, EDQUOT: 19, EEXIST: 20, EFBIG: 22, EINTR: 27, EINVAL: 28,
  EIO: 29, EISDIR: 31, ELOOP: 32, EMFILE: 33, EMLINK: 34, ENAMETOOLONG: 37, ENFILE: 41, ENODEV: 43, ENOENT: 44,
  ENOMEM: 48, ENOSPC: 51, ENOSYS: 52, ENOTDIR: 54, ENOTEMPTY: 55, ENOTSUP: 58, ENXIO: 60, EOVERFLOW: 61, EPERM: 63,
  EPIPE: 64, EROFS: 69, ESPIPE: 70, ETXTBSY: 74, EXDEV: 75, ENOTCAPABLE: 76,
};
const kDevice = 2, kFolder = 3, kFile = 4, kSocket = 6, kLink = 7;
const kRoot = 3; // the number of the one folder that is open at the start: "/"
const kSeek = 1n << 2n, kTell = 1n << 5n, kRead = 1n << 1n, kWrite = 1n << 6n;
const kAll = (1n << 30n) - 1n;

const failure = (code) => Object.assign(new Error(code), { code });
const bytesOf = (name) => Buffer.from(name, 'latin1');
const textOf = (name) => Buffer.from(name, 'utf8').toString('latin1');
const pause = (milliseconds) => Atomics.wait(new Int32Array(new SharedArrayBuffer(4)), 0, 0, milliseconds);

export class Exit extends Error {
  constructor(status) {
    super(`status ${status}`);
    this.status = status;
  }
}

function kindOf(status) {
  if (status.isFile()) return kFile;
  if (status.isDirectory()) return kFolder;
  if (status.isSymbolicLink()) return kLink;
  if (status.isCharacterDevice()) return kDevice;
  return status.isBlockDevice() ? 1 : status.isSocket() ? kSocket : 0;
}

/** The arguments, with those in the lists that they name: @FILE and --files-from. */
function withLists(words) {
  const all = [...words], read = new Set();
  for (let k = 0; k < all.length; ++k) {
    const from = /^(?:@|--files-from=)(.*)/.exec(all[k])?.[1] ?? (all[k - 1] === '--files-from' ? all[k] : undefined);
    if (from === undefined || from === '-' || read.has(from)) continue;
    read.add(from);
    try {
      all.push(...fs.readFileSync(from, 'utf8').split(/[\n\0]/));
    } catch {
      // The command will say so.
    }
  }
  return all;
}

/** The folders that the arguments of a command name: names of files may follow "=", "," or ":" in them. */
export function foldersNamed(words) {
  const folders = new Set();
  for (const word of withLists(words)) {
    for (const part of [word, ...word.split(/[=,:]/)]) {
      if (part === '' || part === '-' || part.includes('\0')) continue;
      const name = path.resolve(part.replace(/[*?[{].*$/s, '')); // a pattern begins in a folder
      let folder = path.dirname(name);
      try {
        if (!fs.statSync(name).isFile()) folder = name; // a folder, or a device, whose neighbours are not wanted
      } catch {
        // It is to be made, or the command says what is wrong.
      }
      folders.add(folder);
      try {
        folders.add(fs.realpathSync(folder));
      } catch {
        // The same.
      }
    }
  }
  return [...folders];
}

export class Wasi {
  #memory;
  #files = new Map();
  #folders;
  used = false; // whether bytes have gone through a standard stream

  /**
   * `created` and `removed` are called with the names of files that are being written and have no name of their own
   * yet, or no longer.
   */
  constructor({ args, env, folders, created, removed }) {
    this.args = args;
    this.env = env;
    this.created = created;
    this.removed = removed;
    const slashed = (name) => textOf(process.platform === 'win32' ? `/${name.replaceAll('\\', '/')}` : name);
    this.#folders = folders.map(slashed);
    for (const host of [0, 1, 2]) this.#files.set(host, { host, stream: true });
    const input = fs.fstatSync(0, { bigint: true, throwIfNoEntry: false });
    if (input?.isFile()) this.#files.set(0, { host: 0, at: 0n });
    this.#files.set(kRoot, { folder: '/' });
  }

  /** What WebAssembly imports. A function that fails throws an error with node's code. */
  imports(memory) {
    this.#memory = memory;
    const wrapped = {};
    for (const [name, call] of Object.entries(this.#calls())) {
      wrapped[name] = (...values) => {
        try {
          return call(...values) ?? 0;
        } catch (error) {
          if (error instanceof Exit || error.code === undefined) throw error;
          return kErrors[error.code] ?? kErrors.EIO;
        }
      };
    }
    return new Proxy(wrapped, { get: (known, name) => known[name] ?? (() => kErrors.ENOSYS) });
  }

  get #view() {
    return new DataView(this.#memory().buffer);
  }
  #bytes(at, count) {
    return new Uint8Array(this.#memory().buffer, at >>> 0, count >>> 0);
  }
  #file(number) {
    const file = this.#files.get(number);
    if (file === undefined) throw failure('EBADF');
    return file;
  }
  #open(file) {
    let number = kRoot + 1;
    while (this.#files.has(number)) ++number;
    this.#files.set(number, file);
    return number;
  }

  /** A name in an open folder, which must be in a folder that was given, or above one if only asked about. */
  #path(number, at, count, { above = false } = {}) {
    const folder = this.#file(number).folder;
    if (folder === undefined) throw failure('ENOTDIR');
    let name = Buffer.from(this.#bytes(at, count)).toString('latin1');
    if (name.includes('\0')) throw failure('EINVAL');
    if (process.platform === 'win32') name = name.replace(/^.*[\\/](?=[A-Za-z]:[\\/])/, '');
    const full = path.posix.join('/', folder, name);
    const plain = full.length > 1 ? full.replace(/\/$/, '') : full;
    const within = (inner, outer) => inner === outer || inner.startsWith(outer === '/' ? '/' : `${outer}/`);
    const open = this.#folders.some((given) => within(plain, given) || (above && within(given, plain)));
    if (!open) throw failure('ENOTCAPABLE');
    return process.platform === 'win32' ? full.slice(1) : full;
  }

  #writeStatus(at, status) {
    const view = this.#view;
    view.setBigUint64(at, BigInt.asUintN(64, status.dev), true);
    view.setBigUint64(at + 8, BigInt.asUintN(64, status.ino), true);
    view.setBigUint64(at + 16, BigInt(kindOf(status)), true);
    view.setBigUint64(at + 24, status.nlink, true);
    view.setBigUint64(at + 32, status.size, true);
    view.setBigUint64(at + 40, BigInt.asUintN(64, status.atimeNs), true);
    view.setBigUint64(at + 48, BigInt.asUintN(64, status.mtimeNs), true);
    view.setBigUint64(at + 56, BigInt.asUintN(64, status.ctimeNs), true);
  }
  #status(file) {
    if (file.folder !== undefined) return fs.statSync(bytesOf(file.folder), { bigint: true });
    return fs.fstatSync(file.host, { bigint: true });
  }

  /** Calls move(bytes, position) for each buffer until one is not filled; returns the sum. */
  #each(buffers, count, position, move) {
    let total = 0;
    for (let k = 0; k < count; ++k) {
      const view = this.#view;
      const bytes = this.#bytes(view.getUint32(buffers + 8 * k, true), view.getUint32(buffers + 8 * k + 4, true));
      if (bytes.length === 0) continue;
      const moved = move(bytes, position === null ? null : Number(position) + total); // writeSync() takes no BigInt
      total += moved;
      if (moved < bytes.length) break;
    }
    return total;
  }
  /** A stream may have nothing to give or take yet. */
  #retried(move) {
    for (;;) {
      try {
        return move();
      } catch (error) {
        if (error.code === 'EOF') return 0;
        if (error.code !== 'EAGAIN') throw error;
        pause(2);
      }
    }
  }
  #read(file, bytes, position) {
    if (file.host === undefined) throw failure('EISDIR');
    return this.#retried(() => fs.readSync(file.host, bytes, 0, bytes.length, position));
  }
  #write(file, bytes, position) {
    if (file.host === undefined) throw failure('EISDIR');
    return this.#retried(() => fs.writeSync(file.host, bytes, 0, bytes.length, position));
  }
  #transfer(number, buffers, count, done, move) {
    const file = this.#file(number);
    if (file.stream) this.used = true;
    const total = this.#each(buffers, count, file.at ?? null, (bytes, position) => move(file, bytes, position));
    if (file.at !== undefined) file.at += BigInt(total);
    this.#view.setUint32(done, total, true);
  }

  #strings(list) {
    const encoded = list.map((text) => Buffer.from(`${text}\0`));
    return {
      sizes: (count, size) => {
        this.#view.setUint32(count, encoded.length, true);
        this.#view.setUint32(size, encoded.reduce((sum, { length }) => sum + length, 0), true);
      },
      get: (pointers, at) => {
        for (const [k, bytes] of encoded.entries()) {
          this.#view.setUint32(pointers + 4 * k, at, true);
          this.#bytes(at, bytes.length).set(bytes);
          at += bytes.length;
        }
      },
    };
  }

  #openPath(number, follow, at, count, how, rights, flags, result) {
    const [create, only, exclusive, truncate] = [1, 2, 4, 8].map((bit) => (how & bit) !== 0);
    const name = this.#path(number, at, count);
    const status = fs.statSync(bytesOf(name), { throwIfNoEntry: false });
    const writes = (rights & kWrite) !== 0n;
    const { O_RDONLY, O_WRONLY, O_RDWR, O_CREAT, O_EXCL, O_TRUNC, O_APPEND, O_NONBLOCK, O_NOFOLLOW } = fs.constants;
    let file;
    if (status?.isDirectory() && !create) {
      if (writes && !only) throw failure('EISDIR');
      if ((follow & 1) === 0 && fs.lstatSync(bytesOf(name)).isSymbolicLink()) throw failure('ELOOP');
      fs.accessSync(bytesOf(name), fs.constants.R_OK);
      file = { folder: name };
    } else {
      if (only) throw failure(status ? 'ENOTDIR' : 'ENOENT');
      let mode = writes ? ((rights & kRead) !== 0n ? O_RDWR : O_WRONLY) : O_RDONLY;
      mode |= (create && O_CREAT) | (exclusive && O_EXCL) | (truncate && O_TRUNC);
      mode |= ((flags & 1) && O_APPEND) | ((flags & 4) && O_NONBLOCK) | ((follow & 1) === 0 && O_NOFOLLOW);
      file = { host: fs.openSync(bytesOf(name), mode, 0o666) };
      if (!(flags & 1) && fs.fstatSync(file.host).isFile()) file.at = 0n;
      if (exclusive) this.created(name);
    }
    this.#view.setUint32(result, this.#open(file), true);
  }

  #rename(from, to) {
    const replaced = fs.lstatSync(bytesOf(to), { throwIfNoEntry: false });
    if (replaced?.isFile()) {
      try {
        const { uid, gid } = fs.lstatSync(bytesOf(from));
        if (uid !== replaced.uid || gid !== replaced.gid) fs.lchownSync(bytesOf(from), replaced.uid, replaced.gid);
        fs.chmodSync(bytesOf(from), replaced.mode & 0o7777);
      } catch {
        // Not ours to change.
      }
    }
    fs.renameSync(bytesOf(from), bytesOf(to));
    this.removed(from);
  }

  #readFolder(number, at, count, cookie, used) {
    const file = this.#file(number);
    if (file.folder === undefined) throw failure('ENOTDIR');
    if (cookie === 0n || file.names === undefined)
      file.names = fs.readdirSync(bytesOf(file.folder), { withFileTypes: true, encoding: 'buffer' });
    const target = Buffer.from(this.#memory().buffer, at >>> 0, count);
    let length = 0;
    for (let k = Number(cookie); k < file.names.length && length < count; ++k) {
      const entry = Buffer.alloc(24 + file.names[k].name.length);
      entry.writeBigUInt64LE(BigInt(k + 1), 0);
      entry.writeBigUInt64LE(BigInt(k + 1), 8); // an inode; 0 would be asked for
      entry.writeUInt32LE(file.names[k].name.length, 16);
      entry.writeUInt8(kindOf(file.names[k]), 20);
      file.names[k].name.copy(entry, 24);
      length += entry.copy(target, length);
    }
    this.#view.setUint32(used, length, true);
  }

  #wait(subscriptions, events, count, done) {
    const view = this.#view;
    if (count !== 1 || view.getUint8(subscriptions + 8) !== 0) throw failure('ENOTSUP');
    const absolute = (view.getUint16(subscriptions + 40, true) & 1) !== 0;
    const clock = view.getUint32(subscriptions + 16, true);
    const now = clock === 0 ? BigInt(Date.now()) * 1000000n : process.hrtime.bigint();
    const wanted = view.getBigUint64(subscriptions + 24, true) - (absolute ? now : 0n);
    if (wanted > 0n) pause(Number(wanted) / 1e6);
    view.setBigUint64(events, view.getBigUint64(subscriptions, true), true);
    view.setBigUint64(events + 8, 0n, true);
    view.setUint32(done, 1, true);
  }

  #calls() {
    const args = this.#strings(this.args), env = this.#strings(this.env);
    const number64 = (at, value) => this.#view.setBigUint64(at, value, true);
    return {
      args_get: args.get,
      args_sizes_get: args.sizes,
      environ_get: env.get,
      environ_sizes_get: env.sizes,
      clock_res_get: (_, at) => number64(at, 1000n),
      clock_time_get: (clock, _, at) =>
        number64(at, clock === 0 ? BigInt(Math.round((performance.timeOrigin + performance.now()) * 1e3)) * 1000n
                                 : process.hrtime.bigint()),
      random_get: (at, count) => void globalThis.crypto.getRandomValues(this.#bytes(at, count)),
      sched_yield: () => 0,
      poll_oneoff: (subscriptions, events, count, done) => this.#wait(subscriptions, events, count, done),
      proc_exit: (status) => {
        throw new Exit(status);
      },
      fd_advise: (number) => void this.#file(number),
      fd_close: (number) => {
        const { host } = this.#file(number);
        this.#files.delete(number);
        if (host > 2) fs.closeSync(host);
      },
      fd_datasync: (number) => fs.fdatasyncSync(this.#file(number).host),
      fd_sync: (number) => fs.fsyncSync(this.#file(number).host),
      fd_fdstat_get: (number, at) => {
        const file = this.#file(number), kind = kindOf(this.#status(file));
        // The C library takes a device that cannot seek for a terminal.
        const rights = file.host !== undefined && tty.isatty(file.host) ? kAll & ~(kSeek | kTell) : kAll;
        number64(at, BigInt(kind));
        number64(at + 8, rights);
        number64(at + 16, kAll);
      },
      fd_fdstat_set_flags: () => 0,
      fd_filestat_get: (number, at) => this.#writeStatus(at, this.#status(this.#file(number))),
      fd_filestat_set_size: (number, size) => fs.ftruncateSync(this.#file(number).host, Number(size)),
      fd_prestat_get: (number, at) => {
        if (number !== kRoot) throw failure('EBADF');
        number64(at, 1n << 32n);
      },
      fd_prestat_dir_name: (_, at) => void this.#bytes(at, 1).fill(0x2f),
      fd_read: (number, buffers, count, done) =>
        this.#transfer(number, buffers, count, done, (file, bytes, position) => this.#read(file, bytes, position)),
      fd_write: (number, buffers, count, done) =>
        this.#transfer(number, buffers, count, done, (file, bytes, position) => this.#write(file, bytes, position)),
      fd_pread: (number, buffers, count, position, done) => {
        const file = this.#file(number);
        this.#view.setUint32(done, this.#each(buffers, count, position, (bytes, at) => this.#read(file, bytes, at)), true);
      },
      fd_pwrite: (number, buffers, count, position, done) => {
        const file = this.#file(number);
        this.#view.setUint32(done, this.#each(buffers, count, position, (bytes, at) => this.#write(file, bytes, at)), true);
      },
      fd_readdir: (...values) => this.#readFolder(...values),
      fd_seek: (number, by, from, at) => {
        const file = this.#file(number);
        if (file.at === undefined) throw failure('ESPIPE');
        const base = [0n, file.at, from === 2 ? this.#status(file).size : 0n][from];
        if (base === undefined || base + by < 0n) throw failure('EINVAL');
        number64(at, (file.at = base + by));
      },
      fd_tell: (number, at) => {
        const file = this.#file(number);
        if (file.at === undefined) throw failure('ESPIPE');
        number64(at, file.at);
      },
      path_create_directory: (number, at, count) => fs.mkdirSync(bytesOf(this.#path(number, at, count))),
      path_remove_directory: (number, at, count) => fs.rmdirSync(bytesOf(this.#path(number, at, count))),
      path_unlink_file: (number, at, count) => {
        const name = this.#path(number, at, count);
        fs.unlinkSync(bytesOf(name));
        this.removed(name);
      },
      path_filestat_get: (number, follow, at, count, to) => {
        const ask = (follow & 1) !== 0 ? fs.statSync : fs.lstatSync;
        this.#writeStatus(to, ask(bytesOf(this.#path(number, at, count, { above: true })), { bigint: true }));
      },
      path_filestat_set_times: (number, _, at, count, accessed, modified, which) => {
        const name = bytesOf(this.#path(number, at, count)), before = fs.statSync(name);
        const seconds = (value, bits, old) => ((which & bits[0]) !== 0 ? Number(value) / 1e9 : which & bits[1] ? Date.now() / 1e3 : old);
        fs.utimesSync(name, seconds(accessed, [1, 2], before.atimeMs / 1e3), seconds(modified, [4, 8], before.mtimeMs / 1e3));
      },
      path_open: (...values) => this.#openPath(...values.slice(0, 6), ...values.slice(7)),
      path_readlink: (number, at, count, to, most, done) => {
        const target = fs.readlinkSync(bytesOf(this.#path(number, at, count, { above: true })), 'buffer').subarray(0, most);
        this.#bytes(to, target.length).set(target);
        this.#view.setUint32(done, target.length, true);
      },
      path_rename: (number, at, count, other, to, length) =>
        this.#rename(this.#path(number, at, count), this.#path(other, to, length)),
    };
  }
}
