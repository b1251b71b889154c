import { defineConfig } from "vite";

// `npm run dev` serves the page with hot reload beside a service that runs on its usual port.
export default defineConfig({
  build: { target: "es2022" },
  server: { proxy: { "/api": "http://127.0.0.1:8000" } },
});
