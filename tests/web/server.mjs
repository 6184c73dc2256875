// A server on 127.0.0.1 for one browser: folders from disk, tables and pictures from memory.
import { createReadStream } from 'node:fs';
import { stat } from 'node:fs/promises';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';

const types = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript' };

// folders: { '/prefix/': folder }. Returns { url, memory: Map of path to Buffer, missing: paths without a file, close() }.
export async function serve(folders) {
  const memory = new Map();
  const missing = [];
  const server = createServer(async (request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, 'http://127.0.0.1').pathname));
    if (request.method === 'PUT') {
      const parts = [];
      for await (const part of request) parts.push(part);
      memory.set(path, Buffer.concat(parts));
      response.writeHead(204).end();
      return;
    }
    const type = types[extname(path)] ?? 'application/octet-stream';
    if (memory.has(path)) {
      response.writeHead(200, { 'Content-Type': type, 'Cache-Control': 'no-store' }).end(memory.get(path));
      return;
    }
    const prefix = Object.keys(folders).find((p) => path.startsWith(p));
    const file = prefix && join(folders[prefix], path.slice(prefix.length));
    const isFile = file && await stat(file).then((s) => s.isFile(), () => false);
    if (!isFile) {
      missing.push(path);
      response.writeHead(404).end();
      return;
    }
    // cached: the engines stay the same while the test runs
    response.writeHead(200, { 'Content-Type': type, 'Cache-Control': 'max-age=3600' });
    createReadStream(file).pipe(response);
  });
  await new Promise((resolve, reject) => {
    server.once('error', reject);
    server.listen(0, '127.0.0.1', resolve);
  });
  const close = () => new Promise((resolve) => {
    server.close(resolve);
    server.closeAllConnections();
  });
  return { url: `http://127.0.0.1:${server.address().port}`, memory, missing, close };
}
