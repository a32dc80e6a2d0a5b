// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// A file server on the loopback address, as simple as a static host:
//     node server.mjs FOLDER [PORT]

import { createReadStream } from 'node:fs';
import { stat } from 'node:fs/promises';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';

const types = {
    '.html': 'text/html',
    '.css': 'text/css',
    '.js': 'text/javascript',
    '.mjs': 'text/javascript',
    '.json': 'application/json',
    '.wasm': 'application/wasm',
    '.png': 'image/png',
    '.txt': 'text/plain',
};

// headers: more of them, for each answer. Returns the address and close().
export async function serve(folder, { port = 0, headers = {} } = {}) {
    const server = createServer(async (request, response) => {
        let file;
        try {
            const path = normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname));
            file = join(folder, path.endsWith('/') ? `${path}index.html` : path);
            if (!(await stat(file)).isFile()) throw new Error('not a file');
        } catch {
            response.writeHead(404).end();
            return;
        }
        response.writeHead(200, { 'Content-Type': types[extname(file)] ?? 'application/octet-stream', ...headers });
        createReadStream(file).pipe(response);
    });
    await new Promise(resolve => server.listen(port, '127.0.0.1', resolve));
    return { address: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() };
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
    // Without these, browsers allow no threads that share memory.
    const headers = { 'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp' };
    const { address } = await serve(process.argv[2], { port: Number(process.argv[3] ?? 0), headers });
    console.log(address);
}
