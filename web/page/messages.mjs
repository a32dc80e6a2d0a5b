// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What the page says while it works: a sentence if something is wrong, the status, and that it is busy

import { Cancelled } from './matcher_client.mjs';

const get = id => document.getElementById(id);

export function showError(error) {
    if (error instanceof Cancelled) return;
    const message = get('message');
    message.textContent = error.message;
    message.hidden = false;
    setBusy(false);
    showStatus(document.body.classList.contains('has-result') ? 'The map below is that of the last pair.' : '');
}

export function clearError() {
    get('message').hidden = true;
}

export function showStatus(text) {
    get('status').textContent = text;
}

export function setBusy(isBusy) {
    get('stage').setAttribute('aria-busy', isBusy);
    clearTimeout(setBusy.timer);
    if (!isBusy) get('busy').hidden = true;
    else
        // shorter runs do without
        setBusy.timer = setTimeout(() => {
            get('busy').hidden = false;
        }, 150);
}

// A sentence stays until something else is tried.
export const attempt =
    action =>
    (...args) => {
        clearError();
        return Promise.resolve()
            .then(() => action(...args))
            .catch(showError);
    };
