// SPDX-License-Identifier: Apache-2.0
import { defineConfig, type Plugin, type UserConfig } from 'vite';

/** Code for an inline script: nothing in it ends the script element. */
const scriptSafe = (code: string): string => code.replace(/<\/(script)/gi, '<\\/$1').replace(/<!--/g, '<\\!--');

/** Puts the script and the style sheet into the page, so that dist/`file` needs no other file. */
function inlineEverything(file: string): Plugin {
  return {
    name: 'inline-everything',
    enforce: 'post',
    generateBundle(_options, bundle) {
      const page = bundle[file];
      if (page?.type !== 'asset') throw new Error(`the build has no ${file}`);
      let html = String(page.source).replace(/\s*<(script|link)[^>]*(src|href)="[^"]*"[^>]*>(<\/script>)?/g, '');
      for (const [name, part] of Object.entries(bundle)) {
        if (part === page) continue;
        const style = part.type === 'asset' && name.endsWith('.css');
        if (style) html = html.replace('</head>', () => `<style>${String(part.source)}</style></head>`);
        if (part.type === 'chunk') {
          html = html.replace('</body>', () => `<script type="module">${scriptSafe(part.code)}</script>\n</body>`);
        }
        if (style || part.type === 'chunk') delete bundle[name];
      }
      page.source = html;
    },
  };
}

const kCommon = { target: 'es2022', cssCodeSplit: false, modulePreload: false, emptyOutDir: false } as const;

/** dist/service.html with /app.js and /app.css: the service's content security policy forbids inline scripts and styles. */
const kService: UserConfig = {
  base: '/',
  build: {
    ...kCommon,
    assetsInlineLimit: 0,
    rollupOptions: {
      input: 'service.html',
      output: { inlineDynamicImports: true, entryFileNames: 'app.js', assetFileNames: 'app[extname]' },
    },
  },
};

/**
 * `vite build` makes dist/report.html, `vite build --mode summary` makes dist/summary.html, each one self-contained file.
 * `vite build --mode service` makes the page of the service, three files.
 */
export default defineConfig(({ mode }) => {
  if (mode === 'service') return kService;
  const page = mode === 'summary' ? 'summary.html' : 'report.html';
  return {
    base: './',
    plugins: [inlineEverything(page)],
    build: {
      ...kCommon,
      assetsInlineLimit: 1e8,
      rollupOptions: { input: page, output: { inlineDynamicImports: true } },
    },
  };
});
